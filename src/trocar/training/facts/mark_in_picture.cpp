// Where a mark lies in the picture: how far from its middle, how far from the lens, how it faces it. All unknown while
// the mark is not in view. And how far it has been moved, seen or not.
#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/directions.hpp>
#include <trocar/training/observe/marks.hpp>

namespace trocar::training {
namespace {

Value off_centre(const Snapshot& snapshot, const Arguments& a) {
  if (!sim::visible(snapshot.model, snapshot.state, a[0].index)) return kUnknown;
  const kinematics::ScopeFrame scope = sim::scope_of(snapshot.model, snapshot.state);
  const Vec3d to = place_of_mark(snapshot.model, snapshot.state, a[0].index) - scope.eye;
  const double ahead = dot(to, scope.forward);
  if (ahead <= 0) return kUnknown;
  const double aside = length(to - ahead * scope.forward);
  const double half = 0.5 * snapshot.model.scope.field_of_view;
  return aside / ahead * portable::cos(half) / portable::sin(half);
}

Value distance(const Snapshot& snapshot, const Arguments& a) {
  if (!sim::visible(snapshot.model, snapshot.state, a[0].index)) return kUnknown;
  return length(place_of_mark(snapshot.model, snapshot.state, a[0].index) -
                sim::scope_of(snapshot.model, snapshot.state).eye);
}

Value facing(const Snapshot& snapshot, const Arguments& a) {
  if (!sim::visible(snapshot.model, snapshot.state, a[0].index)) return kUnknown;
  const std::optional<Vec3d> normal = normal_of_mark(snapshot.model, snapshot.state, a[0].index);
  if (!normal) return kUnknown;
  const Vec3d to_eye = normalised(sim::scope_of(snapshot.model, snapshot.state).eye -
                                  place_of_mark(snapshot.model, snapshot.state, a[0].index));
  return portable::atan2(length(cross(*normal, to_eye)), dot(*normal, to_eye));
}
std::string faces_every_way(const sim::Model& model, const Arguments& a) {
  const sim::VisibilityTarget& target = model.targets[size_t(a[0].index)];
  if (can_face(model, target)) return "";
  return tr("expected a mark on an organ or a disc, got \"{}\", which has no single normal", target.name);
}

/// Against where it was when it was first looked at: in the drawn shape.
class Moved final : public Observer {
 public:
  Moved(const sim::Model&, const Arguments& a) : m_mark(a[0].index), m_way(patient_direction(a[1].word)) {}
  void sample(const Snapshot& snapshot, double) override {
    if (!m_from) m_from = place_of_mark(snapshot.model, snapshot.state, m_mark);
  }
  Value value(const Snapshot& snapshot) const override {
    if (!m_from) return kUnknown;
    return dot(place_of_mark(snapshot.model, snapshot.state, m_mark) - *m_from, m_way);
  }

 private:
  std::int32_t m_mark;
  Vec3d m_way;
  std::optional<Vec3d> m_from;
};

}  // namespace

const Fact kMarkMoved{
    "mark.moved_mm",
    {{"of", ArgumentKind::mark, "the mark that moves"},
     {"towards", ArgumentKind::word, "direction of the patient", true, 0, 0, patient_directions()}},
    -1000,
    1000,
    "Displacement of the mark's centre since the start in that direction; negative in the opposite one.",
    anywhere,
    &remembering<Moved>};

const Fact kMarkOffCentre{
    "mark.off_centre",
    {{"of", ArgumentKind::mark, "the mark"}},
    0,
    10,
    "Distance of the mark from the picture's centre, as a share of the picture's radius. Unknown while "
    "it is not in view.",
    anywhere,
    &stateless<off_centre>};
const Fact kMarkDistance{"mark.distance_mm",
                         {{"of", ArgumentKind::mark, "the mark"}},
                         0,
                         1000,
                         "Distance from the lens to the mark's centre. Unknown while it is not in view.",
                         anywhere,
                         &stateless<distance>};
const Fact kMarkFacing{"mark.facing_deg",
                       {{"of", ArgumentKind::mark, "a mark on a disc or an organ"}},
                       0,
                       180,
                       "Angle between the line to the lens and the surface normal at the mark. Unknown "
                       "while it is not in view, and for marks without a single normal.",
                       anywhere,
                       &stateless<facing>,
                       false,
                       faces_every_way};

}  // namespace trocar::training

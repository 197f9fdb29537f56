#include <algorithm>

#include <trocar/training/observe/hands.hpp>
#include <trocar/training/skills/parameters.hpp>
#include <trocar/training/skills/registry.hpp>

namespace trocar::training {
namespace {

/// A place from changing distances, for a time.
class Inspect final : public Skill {
 public:
  Inspect(const sim::Model& model, const SkillArgs& args)
      : m_place(model, args), m_time(args.number("for_s", 2)), m_aside(args.number("aside_mm", 0)) {}

 private:
  Progress work(Surgeon& op) override {
    const Vec3d at = m_place.point(op, -1);
    op.want(at);
    if (m_aside > 0) op.want(at - Vec3d{at.x > 0 ? m_aside : -m_aside, 0, 0});
    op.from(0.05 + 0.01 * double(int(m_in_phase / 4) % 4));
    return m_in_phase > m_time ? Progress::done : Progress::working;
  }
  Place m_place;
  double m_time, m_aside;
};

/// Both ends that a cut has made, in view together.
class InspectStumps final : public Skill {
 public:
  InspectStumps(const sim::Model& model, const SkillArgs& args);

 private:
  Progress work(Surgeon& op) override;
  int m_strand, m_trace;
  double m_time;
};

InspectStumps::InspectStumps(const sim::Model& model, const SkillArgs& args)
    : m_strand(args("of").index),
      m_trace(model.target_index(model.strands[size_t(m_strand)].name + ".trace")),
      m_time(args.number("for_s", 2)) {}

Progress InspectStumps::work(Surgeon& op) {
  constexpr double kBeside = 0.003, kSure = 0.2;  // [m] of the cut; [s] longer
  op.make_room(op.who_presents(m_strand));
  const int cut = op.cut_element(m_strand);
  if (cut < 0) return fail("it is not cut");
  const interactions::StrandBody& body = op.model().strand_bodies[size_t(m_strand)];
  op.want(op.point(m_strand, std::max(0.0, body.arc[size_t(cut)] - kBeside)));
  op.want(op.point(m_strand, body.arc[size_t(cut) + 1] + kBeside));
  op.from(0.05 + 0.01 * double(int(m_in_phase / 4) % 4));
  const bool seen = stumps_in_view(op.model(), op.state(), m_trace, cut);
  m_steady = seen ? m_steady + sim::kTick : 0;
  return m_steady < m_time + kSure ? Progress::working : Progress::done;
}

}  // namespace

const SkillKind kInspect{
    "inspect",
    "look at the place",
    place_parameters() +
        std::vector<Parameter>{
            number_parameter("for_s", "time; default 2", 0, 600),
            number_parameter("aside_mm", "also shows a place this far towards the patient's middle; default 0", 0,
                             200)},
    60,
    "Looks at a place from changing distances.",
    Place::lacks,
    &making<Inspect>};
const SkillKind kInspectStumps{
    "inspect_stumps",
    "inspect the stumps",
    {{"of", ArgumentKind::strand, "the rod that was cut"},
     number_parameter("for_s", "time that both must be in view without a break; default 2", 0, 60)},
    20,
    "Looks at both stumps of a cut.",
    nothing,
    &making<InspectStumps>};

}  // namespace trocar::training

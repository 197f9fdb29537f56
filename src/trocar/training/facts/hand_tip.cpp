// How far an instrument's tip is from something, and how it points there.
#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/observe/marks.hpp>

namespace trocar::training {
namespace {

Value to_mark(const Snapshot& snapshot, const Arguments& a) {
  return length(tip_of(snapshot.model, snapshot.state, size_t(a[0].index)) -
                place_of_mark(snapshot.model, snapshot.state, a[1].index));
}
Value to_hand(const Snapshot& snapshot, const Arguments& a) {
  return length(tip_of(snapshot.model, snapshot.state, size_t(a[0].index)) -
                tip_of(snapshot.model, snapshot.state, size_t(a[1].index)));
}

Value jaws_to_mark(const Snapshot& snapshot, const Arguments& a) {
  const std::optional<Vec3d> normal = normal_of_mark(snapshot.model, snapshot.state, a[1].index);
  if (!normal) return kUnknown;
  const Vec3d axis = sim::tip_frame_of(snapshot.model, snapshot.state, size_t(a[0].index)).axis();
  return portable::atan2(length(cross(axis, *normal)), -dot(axis, *normal));
}
std::string marks_that_face(const sim::Model& model, const Arguments& a) {
  const sim::VisibilityTarget& target = model.targets[size_t(a[1].index)];
  if (can_face(model, target)) return "";
  return tr("expected a mark on an organ or a disc, got \"{}\", which has no single normal", target.name);
}

}  // namespace

const Fact kHandJawsToMark{
    "hand.jaws_to_mark_deg",
    {{"hand", ArgumentKind::hand, "whose instrument"}, {"mark", ArgumentKind::mark, "a mark on a disc or an organ"}},
    0,
    180,
    "Angle between the axis of the instrument's jaws and the inward normal of the surface at the mark: 0 "
    "when the jaws point into the surface, 90 along it.",
    anywhere,
    &stateless<jaws_to_mark>,
    false,
    marks_that_face};
const Fact kHandTipToMark{"hand.tip_to_mark_mm",
                          {{"hand", ArgumentKind::hand, "whose instrument"}, {"mark", ArgumentKind::mark, "to which"}},
                          0,
                          1000,
                          "Distance from the instrument's tip to the mark's centre.",
                          anywhere,
                          &stateless<to_mark>};
const Fact kHandTipToHand{"hand.tip_to_hand_mm",
                          {{"hand", ArgumentKind::hand, "whose instrument"}, {"other", ArgumentKind::hand, "to whose"}},
                          0,
                          1000,
                          "Distance between the tips of two instruments.",
                          anywhere,
                          &stateless<to_hand>};

}  // namespace trocar::training

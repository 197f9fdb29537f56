#include <trocar/sim/model/mark.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

Value apart(const Snapshot& snapshot, const Arguments& a) {
  Vec3d at[2];
  for (int k = 0; k < 2; ++k) {
    const sim::VisibilityTarget& t = snapshot.model.targets[size_t(a[size_t(k)].index)];
    if (t.kind != sim::VisibilityTarget::mark) return kUnknown;
    at[k] = sim::pose_of(snapshot.model, snapshot.state, snapshot.model.marks[size_t(t.index)]).place;
  }
  return length(at[1] - at[0]);
}

}  // namespace

const Fact kMarksApart{
    "mark.apart_mm",
    {{"of", ArgumentKind::mark, "a mark"}, {"from", ArgumentKind::mark, "another one"}},
    0,
    2000,
    "Present distance between the centres of two marks, for example the gap of a slit between marks beside it.",
    anywhere,
    &stateless<apart>};

}  // namespace trocar::training

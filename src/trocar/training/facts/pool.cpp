#include <trocar/training/facts/needs.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

/// What lay in the pool when the scene began was spilled before.
Value spilled(const Snapshot& snapshot, const Arguments&) {
  const std::int64_t out = snapshot.state.fluids.ledger.in[size_t(fluids::Source::kBled)].bile;
  return fluids::kM3PerPicolitre * double(out - snapshot.model.wet.pool_at_start.bile);
}

Value pool(const Snapshot& snapshot, const Arguments&) {
  return fluids::kM3PerPicolitre * double(at(snapshot.state.fluids.ledger, fluids::Place::kPool).total());
}

}  // namespace

const Fact kBileSpilled{
    "bile.spilled_mL",  {}, 0, 1e4, "Volume that left open closed membranes, such as bile, so far.", needs_fluids,
    &stateless<spilled>};
const Fact kPoolVolume{"pool.volume_mL", {}, 0, 1e4, "Volume of pooled fluid.", needs_fluids, &stateless<pool>};

}  // namespace trocar::training

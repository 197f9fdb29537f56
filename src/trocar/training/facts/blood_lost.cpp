#include <trocar/training/facts/needs.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/blood.hpp>

namespace trocar::training {
namespace {

Value lost(const Snapshot& snapshot, const Arguments&) { return blood_lost(snapshot.model, snapshot.state); }

}  // namespace

const Fact kBloodLost{"blood.lost_mL", {}, 0, 1e4, "Blood that left vessels so far.", needs_fluids, &stateless<lost>};

}  // namespace trocar::training

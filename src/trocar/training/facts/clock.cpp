#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

Value seconds(const Snapshot& snapshot, const Arguments&) { return snapshot.now(); }

}  // namespace

const Fact kClock{"attempt.time_s", {}, 0, 36000, "Time since the start.", anywhere, &stateless<seconds>};

}  // namespace trocar::training

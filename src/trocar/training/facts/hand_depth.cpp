#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

Value depth(const Snapshot& snapshot, const Arguments& a) { return snapshot.state.tools[size_t(a[0].index)].depth; }

}  // namespace

const Fact kHandDepth{"hand.depth_mm",
                      {{"hand", ArgumentKind::hand, "whose instrument"}},
                      0,
                      400,
                      "Insertion depth of the instrument from its port.",
                      anywhere,
                      &stateless<depth>};

}  // namespace trocar::training

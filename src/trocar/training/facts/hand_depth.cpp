#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

Value depth(const Look& look, const Arguments& a) { return look.state.tools[size_t(a[0].index)].depth; }

}  // namespace

const Fact kHandDepth{"hand.depth_mm",
                      {{"hand", ArgumentKind::hand, "whose instrument"}},
                      0,
                      400,
                      "How deep the instrument is in, from its trocar.",
                      anywhere,
                      &stateless<depth>};

}  // namespace trocar::training

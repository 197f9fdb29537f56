#include <algorithm>

#include <trocar/sim/model/bodies.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

double share_of(const std::vector<std::uint8_t>& open) {
  return open.empty() ? 0 : double(std::count(open.begin(), open.end(), 1)) / double(open.size());
}

Value parted(const Snapshot& snapshot, const Arguments& a) {
  return sim::visit(
      snapshot.model, a[0].body(), kUnknown,
      sim::Overloaded{[&](sim::MembraneRef fold) -> Value { return share_of(snapshot.state.torn[fold.index]); },
                      [&](sim::SolidRef solid) -> Value { return share_of(snapshot.state.parted[solid.index]); },
                      [](auto) { return kUnknown; }});
}

}  // namespace

const Fact kBodyParted{"body.parted_share",
                       {{"of", ArgumentKind::body, "a fold or an organ"}},
                       0,
                       1,
                       "The share of its surface's triangles that have been cut or torn open. Unknown for strands and "
                       "for organs that are cut as volumes.",
                       anywhere,
                       &stateless<parted>};

}  // namespace trocar::training

#include <algorithm>

#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

double share_of(const std::vector<std::uint8_t>& open) {
  return open.empty() ? 0 : double(std::count(open.begin(), open.end(), 1)) / double(open.size());
}

Value parted(const Look& look, const Arguments& a) {
  const std::int32_t body = a[0].index;
  if (body >= interactions::kMembraneBase) return share_of(look.state.torn[size_t(body - interactions::kMembraneBase)]);
  if (body < interactions::kSolidBase) return kUnknown;
  const size_t organ = size_t(body - interactions::kSolidBase);
  return organ < look.state.parted.size() ? Value(share_of(look.state.parted[organ])) : kUnknown;
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

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <trocar/interactions/bodies/loads.hpp>

namespace trocar::interactions {

namespace {

/// Adds an isotropic load to another on the same node: k1 (x1 - x) + k2 (x2 - x) = (k1 + k2) (mean - x).
void merge(const tissue::NodeLoad& load, tissue::NodeLoad& into) noexcept {
  const float k = into.k + load.k;
  if (k > 0) into.x0 = (into.k / k) * into.x0 + (load.k / k) * load.x0;
  if (k > 0) into.u = (into.k / k) * into.u + (load.k / k) * load.u;
  into.f0 += load.f0;
  into.k = k;
  into.d += load.d;
}

}  // namespace

void NetworkLoads::reserve(std::size_t capacity) {
  gathered.reserve(capacity);
  sorted.reserve(capacity);
  tag.reserve(capacity);
  point.reserve(capacity);
  order.reserve(capacity);
  spare.reserve(capacity);
  owner.reserve(capacity);
  reaction.reserve(capacity);
}

void NetworkLoads::clear() noexcept {
  gathered.clear();
  tag.clear();
  point.clear();
  overflowed = false;
}

void NetworkLoads::add(const tissue::NodeLoad& load, Tag t, bool share) noexcept {
  if (gathered.size() == gathered.capacity()) {
    overflowed = true;
    return;
  }
  gathered.push_back(load);
  tag.push_back(t);
  point.push_back(share && !point.empty() ? point.back() : std::int32_t(point.size()));
}

void NetworkLoads::keep_order() noexcept {
  sorted.assign(gathered.begin(), gathered.end());
  owner.assign(tag.begin(), tag.end());
  reaction.assign(sorted.size(), Vec3f{});
}

void NetworkLoads::order_by_node() noexcept {
  std::uint32_t most = 0;
  order.clear();
  for (std::size_t i = 0; i < gathered.size(); ++i) {
    order.push_back(std::uint64_t(gathered[i].node) << 32 | i);
    most = std::max(most, std::uint32_t(gathered[i].node));
  }
  spare.resize(order.size());
  for (int bits = 0; bits < 32 && most >> bits != 0; bits += 8) {  // a radix sort: what is equal keeps its order
    const auto digit = [bits](std::uint64_t key) { return std::size_t(key >> (32 + bits) & 0xff); };
    std::array<std::uint32_t, 257> first{};
    for (const std::uint64_t key : order) ++first[digit(key) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    for (const std::uint64_t key : order) spare[first[digit(key)]++] = key;
    order.swap(spare);
  }
}

void NetworkLoads::sort() noexcept {
  order_by_node();
  sorted.clear();
  owner.clear();
  for (const std::uint64_t key : order) {
    const std::size_t i = std::size_t(key & 0xffffffffu);
    const tissue::NodeLoad& load = gathered[i];
    const Tag& t = tag[i];
    const bool anonymous = t.owner == Owner::anchor || t.owner == Owner::strand_end;
    if (anonymous && !sorted.empty() && owner.back().owner == Owner::anchor && sorted.back().node == load.node) {
      merge(load, sorted.back());
    } else {
      sorted.push_back(load);
      owner.push_back(anonymous ? Tag{Owner::anchor, 0, 0} : t);
    }
  }
  reaction.assign(sorted.size(), Vec3f{});
}

bool NetworkLoads::handled() const noexcept {
  return std::any_of(tag.begin(), tag.end(),
                     [](const Tag& t) { return t.owner == Owner::tool_contact || t.owner == Owner::tool_hold; });
}

void StrandLoads::reserve(std::size_t capacity) {
  list.reserve(capacity);
  tag.reserve(capacity);
  reaction.reserve(capacity);
}

void StrandLoads::clear() noexcept {
  list.clear();
  tag.clear();
  overflowed = false;
}

void StrandLoads::add(const tissue::StrandLoad& load, Tag t) noexcept {
  if (list.size() == list.capacity()) {
    overflowed = true;
    return;
  }
  list.push_back(load);
  tag.push_back(t);
}

Vec3d counted_on(Vec3d velocity) noexcept {
  constexpr double kMost = 20;  // [m/s]
  const double square = dot(velocity, velocity);
  return square > kMost * kMost ? (kMost / std::sqrt(square)) * velocity : velocity;
}

void add_skin_load(const tissue::NodeView& nodes, const tissue::Skin& skin, int vertex, const SkinLoad& load, Tag tag,
                   NetworkLoads& loads, float least) noexcept {
  const Vec3f origin = vec_cast<float>(nodes.origin);
  bool another = false;
  skin.each_carrier(vertex, [&](int carrier, int row, float share) {
    if (share < least) return;
    const tissue::NodeState& n = nodes.rows[std::size_t(row)];
    tissue::NodeLoad node;
    node.node = carrier;
    node.f0 = share * vec_cast<float>(load.f0);
    node.k = share * float(load.k);
    node.x0 = Vec3f{n.x, n.y, n.z} + origin + vec_cast<float>(load.shift);
    node.dir = vec_cast<float>(load.dir);
    node.d = share * float(load.d);
    loads.add(node, tag, another);
    another = true;
  });
}

}  // namespace trocar::interactions

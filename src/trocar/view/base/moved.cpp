#include <algorithm>

#include <trocar/view/base/moved.hpp>

namespace trocar::view {
namespace {

Vec3f place_of(const tissue::NodeState& n) { return {float(n.x), float(n.y), float(n.z)}; }
Vec3f place_of(Vec3d n) { return vec_cast<float>(n); }

template <class Node>
bool moved(std::span<const Node> nodes, std::vector<Vec3f>& drawn) {
  const auto near = [](const Node& now, Vec3f before) {
    const Vec3f way = place_of(now) - before;
    return dot(way, way) <= float(kSeenToMove * kSeenToMove);
  };
  if (std::equal(nodes.begin(), nodes.end(), drawn.begin(), drawn.end(), near)) return false;
  drawn.resize(nodes.size());
  std::transform(nodes.begin(), nodes.end(), drawn.begin(), [](const Node& n) { return place_of(n); });
  return true;
}

}  // namespace

bool Moved::operator()(std::span<const tissue::NodeState> nodes) { return moved(nodes, m_drawn); }
bool Moved::operator()(std::span<const Vec3d> nodes) { return moved(nodes, m_drawn); }

}  // namespace trocar::view

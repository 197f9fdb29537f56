#include <algorithm>
#include <utility>

#include <trocar/core/field_hash.hpp>
#include <trocar/tissue/base/float4.hpp>
#include <trocar/tissue/network/skin.hpp>

namespace trocar::tissue {

bool Box::near_segment(Vec3d a, Vec3d b, double margin) const noexcept {
  for (int k = 0; k < 3; ++k) {
    const double from = std::min(a[k], b[k]) - margin, to = std::max(a[k], b[k]) + margin;
    if (double(high[k]) < from || double(low[k]) > to) return false;
  }
  return true;
}

bool Box::near_box(const Box& other, float margin) const noexcept {
  for (int k = 0; k < 3; ++k)
    if (high[k] + margin < other.low[k] || other.high[k] + margin < low[k]) return false;
  return true;
}

SkinPose make_pose(const Skin& skin) {
  SkinPose pose;
  pose.position.resize(size_t(skin.size()));
  pose.block.resize(size_t(skin.size() + kSkinBlock - 1) / kSkinBlock);
  pose.patch.resize(size_t(skin.size() + kSkinPatch - 1) / kSkinPatch);
  return pose;
}

namespace {

/// A bounding box in registers.
struct Box4 {
  Float4 low = load4(Box{}.low), high = load4(Box{}.high);
  void add(Float4 p) noexcept { low = smaller(p, low), high = larger(p, high); }
  void add(const Box4& b) noexcept { add(b.low), add(b.high); }
  Box box() const noexcept { return {vec3(low), vec3(high)}; }
};

Float4 place_of(const NodeState* q, const SkinWeights& w) noexcept {
  Float4 x{};
  for (size_t j = 0; j < 8; ++j) x += w.weight[j] * load4(&q[w.row[j]].x);
  return x;
}

}  // namespace

void pose_skin(const NodeView& nodes, const Skin& skin, SkinPose& pose) noexcept {
  const Float4 origin = load4(vec_cast<float>(nodes.origin));
  const NodeState* q = nodes.rows.data();
  const bool wide = !skin.more.empty();
  Box4 bounds;
  for (int first = 0; first < skin.size(); first += kSkinBlock) {
    Box4 block;
    const int last = std::min(first + kSkinBlock, skin.size());
    for (int from = first; from < last; from += kSkinPatch) {
      Box4 patch;
      for (int i = from; i < std::min(from + kSkinPatch, last); ++i) {
        if (!skin.at_surface(i)) continue;
        Float4 x = place_of(q, skin.weights[size_t(i)]);
        if (wide) x += place_of(q, skin.more[size_t(i)]);
        x += origin;
        pose.position[size_t(i)] = vec3(x);
        patch.add(x);
      }
      pose.patch[size_t(from / kSkinPatch)] = patch.box();
      block.add(patch);
    }
    pose.block[size_t(first / kSkinBlock)] = block.box();
    bounds.add(block);
  }
  pose.bounds = bounds.box();
}

void index_skin(Skin& skin) {
  const size_t m = size_t(skin.size());
  std::vector<std::pair<int, int>> edges, corners;
  for (size_t f = 0; f < skin.triangles.size(); ++f)
    for (size_t k = 0; k < 3; ++k) {
      const int a = skin.triangles[f][k], b = skin.triangles[f][(k + 1) % 3];
      edges.push_back({a, b});
      edges.push_back({b, a});
      corners.push_back({a, int(f)});
    }
  const auto fill = [m](std::vector<std::pair<int, int>>& pairs, std::vector<int>& first, std::vector<int>& list) {
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    first.assign(m + 1, 0);
    list.clear();
    for (const auto& p : pairs) {
      ++first[size_t(p.first) + 1];
      list.push_back(p.second);
    }
    for (size_t i = 0; i < m; ++i) first[i + 1] += first[i];
  };
  fill(edges, skin.neighbour_first, skin.neighbour);
  fill(corners, skin.face_first, skin.face);
}

Vec3d skin_normal(const Skin& skin, const SkinPose& pose, int vertex) noexcept {
  Vec3d sum{0, 0, 0};
  for (int k = skin.face_first[size_t(vertex)]; k < skin.face_first[size_t(vertex) + 1]; ++k) {
    const auto& t = skin.triangles[size_t(skin.face[size_t(k)])];
    const Vec3d a = vec_cast<double>(pose.position[size_t(t[0])]), b = vec_cast<double>(pose.position[size_t(t[1])]),
                c = vec_cast<double>(pose.position[size_t(t[2])]);
    sum += cross(b - a, c - a);
  }
  return normalised(sum, vec_cast<double>(skin.rest_normal[size_t(vertex)]));
}

Vec3d skin_point(const NodeView& nodes, const Skin& skin, int vertex) noexcept {
  Vec3d p = nodes.origin;
  skin.each_carrier(vertex, [&](int, int row, float weight) {
    const NodeState& n = nodes.rows[size_t(row)];
    p += double(weight) * Vec3d{n.x, n.y, n.z};
  });
  return p;
}

Vec3d skin_velocity(const NodeView& nodes, const Skin& skin, int vertex) noexcept {
  Vec3d v{0, 0, 0};
  skin.each_carrier(vertex, [&](int, int row, float weight) {
    const NodeState& n = nodes.rows[size_t(row)];
    v += double(weight) * Vec3d{n.vx, n.vy, n.vz};
  });
  return v;
}

void add_to_hash(core::Hasher& hasher, const Skin& skin) noexcept { core::add_fields(hasher, skin); }

}  // namespace trocar::tissue

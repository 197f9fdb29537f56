// The skin of a volumetric body: surface points carried by its mechanical nodes, x = W q. Contact, clips, drawing and
// fluids see only skins; forces on the skin go back to the nodes by W transposed.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/tissue/network/node_view.hpp>

namespace trocar::tissue {

inline constexpr int kSkinBlock = 64;  ///< consecutive vertices that share a bounding box
inline constexpr int kSkinPatch = 8;   ///< the same within a block, for who looks for single vertices

/// W row of one skin vertex: eight nodes and their weights (sum 1).
struct SkinWeights {
  std::array<int, 8> node{};  ///< Description's numbering
  std::array<int, 8> row{};   ///< where their State is
  std::array<float, 8> weight{};

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("node", s.node), v("row", s.row), v("weight", s.weight);
  }

  /// Of a vertex that is a node.
  static SkinWeights at(int node, int row) {
    SkinWeights w;
    w.node.fill(node);
    w.row.fill(row);
    w.weight[0] = 1;
    return w;
  }
};

/// Const after compile. Vertices are in a spatially coherent order, so that blocks of kSkinBlock are compact.
struct Skin {
  std::vector<SkinWeights> weights;             ///< (m)
  std::vector<SkinWeights> more;                ///< (m) what rows of W have beyond eight nodes; empty: none has any
  std::vector<std::array<int, 3>> triangles;    ///< outward
  std::vector<Vec3f> rest;                      ///< (m) drawn positions, world [m]
  std::vector<Vec3f> rest_normal;               ///< (m) unit, outward
  std::vector<int> neighbour_first, neighbour;  ///< CSR over vertices, ascending
  std::vector<int> face_first, face;            ///< CSR: triangles at a vertex, ascending

  int size() const { return int(weights.size()); }
  /// f(node, row, weight) for every place of a vertex' row of W, weights of 0 among them.
  template <class F>
  void each_carrier(int vertex, F&& f) const {
    each_of(weights[size_t(vertex)], f);
    if (!more.empty()) each_of(more[size_t(vertex)], f);
  }
  /// Has the vertex a triangle? Bodies that can be cut keep vertices for the nodes inside them.
  bool at_surface(int vertex) const { return face_first[size_t(vertex)] < face_first[size_t(vertex) + 1]; }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("weights", s.weights, core::FieldNote{.made_once = true}),
        v("more", s.more, core::FieldNote{.hashed = !s.more.empty(), .made_once = true}), v("triangles", s.triangles),
        v("rest", s.rest, core::FieldNote{.made_once = true}), v("rest_normal", s.rest_normal, core::kMadeOnce),
        v("neighbour_first", s.neighbour_first, core::kNotHashed), v("neighbour", s.neighbour, core::kNotHashed),
        v("face_first", s.face_first, core::kNotHashed), v("face", s.face, core::kNotHashed);
  }

 private:
  template <class F>
  static void each_of(const SkinWeights& w, F&& f) {
    for (size_t j = 0; j < w.weight.size(); ++j) f(w.node[j], w.row[j], w.weight[j]);
  }
};

struct Box {
  Vec3f low{1e9f, 1e9f, 1e9f}, high{-1e9f, -1e9f, -1e9f};

  void add(Vec3f p) noexcept {
    low = {p.x < low.x ? p.x : low.x, p.y < low.y ? p.y : low.y, p.z < low.z ? p.z : low.z};
    high = {p.x > high.x ? p.x : high.x, p.y > high.y ? p.y : high.y, p.z > high.z ? p.z : high.z};
  }
  bool reaches(Vec3d p, double margin) const noexcept {
    return p.x > low.x - margin && p.x < high.x + margin && p.y > low.y - margin && p.y < high.y + margin &&
           p.z > low.z - margin && p.z < high.z + margin;
  }
  /// To p; no more than that to anything in the box, to the last bit, as all of it is rounded alike.        [m^2]
  double distance2(Vec3d p) const noexcept {
    const double x = outside(p.x, double(low.x), double(high.x)), y = outside(p.y, double(low.y), double(high.y));
    const double z = outside(p.z, double(low.z), double(high.z));
    return x * x + y * y + z * z;
  }
  /// Does the box, grown by `margin`, meet the bounding box of the segment?
  bool near_segment(Vec3d a, Vec3d b, double margin) const noexcept;
  bool near_box(const Box& other, float margin) const noexcept;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("low", s.low), v("high", s.high);
  }

 private:
  static double outside(double p, double low, double high) noexcept {
    return p < low ? low - p : (p > high ? p - high : 0.0);
  }
};

/// Where a skin is now: scratch, refreshed every tick. Vertices that are not at the surface are not refreshed.
struct SkinPose {
  std::vector<Vec3f> position;  ///< (m) world [m]
  std::vector<Box> block;       ///< per kSkinBlock vertices
  std::vector<Box> patch;       ///< per kSkinPatch vertices
  Box bounds;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("position", s.position), v("block", s.block), v("patch", s.patch), v("bounds", s.bounds);
  }
};
SkinPose make_pose(const Skin& skin);

/// x = W q for all vertices and the boxes.
void pose_skin(const NodeView& nodes, const Skin& skin, SkinPose& pose) noexcept;

/// Builds the neighbour and face tables from the triangles.
void index_skin(Skin& skin);

/// Outward unit normal at a vertex of the posed skin (area weighted over its triangles).
Vec3d skin_normal(const Skin& skin, const SkinPose& pose, int vertex) noexcept;

/// Where a vertex is [m], and its velocity [m/s], straight from the nodes: for those who need a few, not the posed
/// skin.
Vec3d skin_point(const NodeView& nodes, const Skin& skin, int vertex) noexcept;
Vec3d skin_velocity(const NodeView& nodes, const Skin& skin, int vertex) noexcept;

void add_to_hash(core::Hasher& hasher, const Skin& skin) noexcept;

}  // namespace trocar::tissue

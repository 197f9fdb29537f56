#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/surface_files/gltf_nodes.hpp>
#include <trocar/numerics/quat.hpp>

namespace trocar::geometry {
namespace {

class GltfNodes {
 public:
  explicit GltfNodes(GltfDocument& gltf) : m_gltf(gltf), m_nodes(gltf.list("nodes")), m_reached(m_nodes.size()) {}

  std::vector<GltfPlaced> placed() {
    for (const std::size_t root : roots()) m_waiting.push_back({root, {}});
    std::reverse(m_waiting.begin(), m_waiting.end());
    while (!m_waiting.empty()) {
      const Waiting next = m_waiting.back();
      m_waiting.pop_back();
      visit(next.node, next.parent);
    }
    return std::move(m_placed);
  }

 private:
  struct Waiting {
    std::size_t node;
    Affine parent;
  };
  GltfDocument& m_gltf;
  std::span<const core::JsonValue> m_nodes;
  std::vector<bool> m_reached;
  std::vector<Waiting> m_waiting;
  std::vector<GltfPlaced> m_placed;

  /// The numbers of nodes in a list of an object, checked.
  std::vector<std::size_t> nodes_of(GltfItem object, const char* key) {
    std::vector<std::size_t> out;
    for (const core::JsonValue& item : m_gltf.items(m_gltf.member(object, key))) {
      const double value = item.number;
      if (item.kind == core::JsonValue::Kind::number && value >= 0 && value < double(m_nodes.size()) &&
          value == double(std::size_t(value)))
        out.push_back(std::size_t(value));
      else
        m_gltf.fault(&item, tr("expected one of {} nodes, got {}", m_nodes.size(), m_gltf.shown(&item)));
    }
    return out;
  }

  std::vector<std::size_t> roots() {
    const std::span<const core::JsonValue> scenes = m_gltf.list("scenes");
    if (const GltfItem shown = m_gltf.named(m_gltf.root(), "scene", "scenes")) return nodes_of(shown, "nodes");
    if (!scenes.empty()) return nodes_of(&scenes.front(), "nodes");
    std::vector<bool> is_child(m_nodes.size());
    for (const core::JsonValue& node : m_nodes)
      for (const std::size_t child : nodes_of(&node, "children")) is_child[child] = true;
    std::vector<std::size_t> out;
    for (std::size_t n = 0; n < m_nodes.size(); ++n)
      if (!is_child[n]) out.push_back(n);
    return out;
  }

  void visit(std::size_t number, const Affine& parent) {
    const GltfItem node = &m_nodes[number];
    if (m_reached[number]) {
      m_gltf.fault(node, tr("expected every node in one place of the tree, got node {} again", number));
      return;
    }
    m_reached[number] = true;
    const Affine own = transform(node), place{parent.linear * own.linear, parent(own.shift)};
    if (const GltfItem mesh = m_gltf.named(node, "mesh", "meshes")) m_placed.push_back({node, mesh, place});
    std::vector<std::size_t> children = nodes_of(node, "children");
    for (auto child = children.rbegin(); child != children.rend(); ++child) m_waiting.push_back({*child, place});
  }

  /// `count` numbers, or the ones that are there by default.
  template <std::size_t count>
  std::array<double, count> numbers(GltfItem node, const char* key, std::array<double, count> otherwise) {
    const GltfItem item = m_gltf.member(node, key);
    if (!item) return otherwise;
    const std::span<const core::JsonValue> values = m_gltf.items(item);
    const bool good = values.size() == count && std::all_of(values.begin(), values.end(), [](const auto& value) {
                        return value.kind == core::JsonValue::Kind::number;
                      });
    if (!good) {
      m_gltf.fault(item, tr("expected {} numbers as {}, got others", count, key));
      return otherwise;
    }
    std::array<double, count> out;
    for (std::size_t k = 0; k < count; ++k) out[k] = values[k].number;
    return out;
  }

  Affine transform(GltfItem node) {
    if (m_gltf.member(node, "matrix")) return from_matrix(node);
    const auto [x, y, z, w] = numbers<4>(node, "rotation", {0, 0, 0, 1});
    const auto [sx, sy, sz] = numbers<3>(node, "scale", {1, 1, 1});
    const auto [tx, ty, tz] = numbers<3>(node, "translation", {0, 0, 0});
    const Mat3d turn = to_mat3(normalised(Quatd{w, x, y, z}));
    return {Mat3d::from_columns(sx * turn.column(0), sy * turn.column(1), sz * turn.column(2)), {tx, ty, tz}};
  }

  Affine from_matrix(GltfItem node) {
    const auto m = numbers<16>(node, "matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    constexpr double kRounded = 1e-5;  // as programs with single precision write it
    if (std::max({std::fabs(m[3]), std::fabs(m[7]), std::fabs(m[11]), std::fabs(m[15] - 1)}) > kRounded)
      m_gltf.fault(m_gltf.member(node, "matrix"), "expected a matrix whose last row is 0 0 0 1, got another one");
    return {Mat3d::from_columns({m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}), {m[12], m[13], m[14]}};
  }
};

}  // namespace

std::vector<GltfPlaced> gltf_placed(GltfDocument& gltf) { return GltfNodes(gltf).placed(); }

}  // namespace trocar::geometry

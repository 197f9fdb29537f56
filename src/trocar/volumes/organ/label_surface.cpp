#include <algorithm>
#include <cmath>

#include <trocar/core/require.hpp>
#include <trocar/geometry/remesh/simplified.hpp>
#include <trocar/geometry/remesh/smoothed.hpp>
#include <trocar/geometry/repair/examine.hpp>
#include <trocar/geometry/repair/untangled.hpp>
#include <trocar/volumes/organ/label_surface.hpp>
#include <trocar/volumes/organ/well_composed.hpp>

namespace trocar::volumes {
namespace {

using geometry::TriMesh;

PaddedVoxels padded(const Labels& labels, int label, const Box& box) {
  PaddedVoxels out;
  for (std::size_t a = 0; a < 3; ++a) out.size[a] = box.high[a] - box.low[a] + 2;
  out.in.assign(std::size_t(out.size[0]) * std::size_t(out.size[1]) * std::size_t(out.size[2]), 0);
  for (int k = box.low[2]; k < box.high[2]; ++k)
    for (int j = box.low[1]; j < box.high[1]; ++j)
      for (int i = box.low[0]; i < box.high[0]; ++i)
        out.in[out.index(i - box.low[0] + 1, j - box.low[1] + 1, k - box.low[2] + 1)] =
            labels.at[labels.grid.index(i, j, k)] == label ? 1 : 0;
  return out;
}

/// Vertices in padded voxels; `centres` are the middles of their cells, at which the surface is that of the voxels.
struct Net {
  TriMesh mesh;
  std::vector<Vec3d> centres;
};

class NetBuilder {
 public:
  explicit NetBuilder(const PaddedVoxels& voxels) : m_voxels(voxels) {
    for (auto& layer : m_layers) layer.assign(std::size_t(voxels.size[0]) * std::size_t(voxels.size[1]), -1);
  }

  Net build(const Progress& progress) {
    for (int k = 0; k + 1 < m_voxels.size[2]; ++k) {
      tell(progress, double(k) / m_voxels.size[2]);
      std::swap(m_layers[0], m_layers[1]);
      std::fill(m_layers[1].begin(), m_layers[1].end(), -1);
      for (int j = 0; j + 1 < m_voxels.size[1]; ++j)
        for (int i = 0; i + 1 < m_voxels.size[0]; ++i) vertex(i, j, k);
      for (int j = 0; j + 1 < m_voxels.size[1]; ++j)
        for (int i = 0; i + 1 < m_voxels.size[0]; ++i) quads(i, j, k);
    }
    return std::move(m_net);
  }

 private:
  const PaddedVoxels& m_voxels;
  std::array<std::vector<int>, 2> m_layers;  // vertices of the cells below and in this layer
  Net m_net;

  int in(int i, int j, int k) const { return m_voxels.in[m_voxels.index(i, j, k)]; }
  int& cell(int i, int j, int up) {
    return m_layers[std::size_t(up)][std::size_t(i) + std::size_t(m_voxels.size[0]) * std::size_t(j)];
  }

  /// In the middle of where the cell's edges cross the border.
  void vertex(int i, int j, int k) {
    int corner[8], count = 0;
    for (int c = 0; c < 8; ++c) count += corner[c] = in(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2 & 1));
    if (count == 0 || count == 8) return;
    Vec3d sum;
    int crossings = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (int c = 0; c < 8; ++c) {
        const int other = c | 1 << axis;
        if (other == c || corner[c] == corner[other]) continue;
        Vec3d middle{double(c & 1), double(c >> 1 & 1), double(c >> 2 & 1)};
        middle[axis] = 0.5;
        sum += middle;
        ++crossings;
      }
    const Vec3d at{double(i), double(j), double(k)};
    cell(i, j, 1) = int(m_net.centres.size());
    m_net.mesh.positions.push_back(at + sum / double(crossings));
    m_net.centres.push_back(at + Vec3d{0.5, 0.5, 0.5});
  }

  /// Between the voxel (i, j, k) and its next along each axis, where they differ: outwards.
  void quads(int i, int j, int k) {
    const int here = in(i, j, k);
    if (here != in(i + 1, j, k)) quad(here, cell(i, j - 1, 0), cell(i, j, 0), cell(i, j, 1), cell(i, j - 1, 1));
    if (here != in(i, j + 1, k)) quad(here, cell(i - 1, j, 0), cell(i - 1, j, 1), cell(i, j, 1), cell(i, j, 0));
    if (here != in(i, j, k + 1)) quad(here, cell(i - 1, j - 1, 1), cell(i, j - 1, 1), cell(i, j, 1), cell(i - 1, j, 1));
  }
  void quad(int forwards, int a, int b, int c, int d) {
    if (forwards == 0) std::swap(b, d);
    const auto& p = m_net.mesh.positions;
    const auto gap = [&](int v, int w) { return length(p[std::size_t(v)] - p[std::size_t(w)]); };
    if (gap(a, c) <= gap(b, d)) {
      m_net.mesh.triangles.push_back({a, b, c});
      m_net.mesh.triangles.push_back({a, c, d});
    } else {
      m_net.mesh.triangles.push_back({a, b, d});
      m_net.mesh.triangles.push_back({b, c, d});
    }
  }
};

/// From padded voxels to the scene [m].
void place_in_scene(Net& net, const Grid& grid, const Box& box) {
  const Vec3d first{double(box.low[0] - 1), double(box.low[1] - 1), double(box.low[2] - 1)};
  const Mat3d step = grid.step();
  const auto placed = [&](Vec3d v) { return scene_from_patient(grid.origin + step * (v + first)); };
  for (Vec3d& p : net.mesh.positions) p = placed(p);
  for (Vec3d& p : net.centres) p = placed(p);
  if (determinant(step) < 0)
    for (auto& t : net.mesh.triangles) std::swap(t[1], t[2]);
}

/// Along the normals until the volume is the wanted one.
void swell_to(TriMesh& mesh, double wanted) {
  for (int round = 0; round < 8; ++round) {
    const double missing = wanted - geometry::volume(mesh), surface = geometry::area(mesh);
    if (!(surface > 0) || std::fabs(missing) <= 1e-7 * wanted) return;
    const std::vector<Vec3d> normals = geometry::vertex_normals(mesh);
    for (std::size_t v = 0; v < normals.size(); ++v) mesh.positions[v] += (missing / surface) * normals[v];
  }
}

/// Also the vertices that share a triangle with one of them.
void add_neighbours(std::vector<bool>& chosen, const TriMesh& mesh) {
  const std::vector<bool> own = chosen;
  for (const auto& t : mesh.triangles)
    if (own[std::size_t(t[0])] || own[std::size_t(t[1])] || own[std::size_t(t[2])])
      for (const int v : t) chosen[std::size_t(v)] = true;
}

/// Vertices of triangles that cross go back towards the middles of their cells, where nothing crosses: first
/// themselves, half of the way; then all of it and more and more around them; at last all. How many.
int untangle(TriMesh& mesh, const std::vector<Vec3d>& centres) {
  constexpr int kHalfWay = 3, kRounds = 10;
  std::vector<bool> held(mesh.positions.size());
  for (int round = 0; round <= kRounds; ++round) {
    const geometry::Diagnosis d = geometry::examine(mesh);
    std::vector<int> bad = d.degenerate;
    for (const auto& pair : d.crossings) bad.insert(bad.end(), {pair[0], pair[1]});
    if (bad.empty() && d.inward.empty()) break;
    // A cavity that has come out of its thin wall faces inwards and crosses nothing: then all go back.
    std::vector<bool> back(mesh.positions.size(), round == kRounds || !d.inward.empty());
    for (const int t : bad)
      for (const int v : mesh.triangles[std::size_t(t)]) back[std::size_t(v)] = true;
    for (int ring = kHalfWay; ring <= round; ++ring) add_neighbours(back, mesh);
    const double share = round < kHalfWay ? 0.5 : 1.0;
    for (std::size_t v = 0; v < back.size(); ++v)
      if (back[v]) mesh.positions[v] += share * (centres[v] - mesh.positions[v]), held[v] = true;
  }
  return int(std::count(held.begin(), held.end(), true));
}

}  // namespace

LabelSurface label_surface(const Labels& labels, int label, const SurfaceOptions& options) {
  const Box box = box_of(labels, label);
  core::require(!box.empty(), "no voxel has this label");
  LabelSurface out;
  out.ml_of_label = millilitres(labels, label);
  PaddedVoxels voxels = padded(labels, label, box);
  out.added_voxels = make_well_composed(voxels);
  Net net = NetBuilder(voxels).build(part(options.progress, 0, 0.4));
  place_in_scene(net, labels.grid, box);
  tell(options.progress, 0.4);
  out.mesh = options.smoothing > 0 ? geometry::smoothed(net.mesh, options.smoothing).mesh : std::move(net.mesh);
  tell(options.progress, 0.6);
  swell_to(out.mesh, 1e-6 * out.ml_of_label);
  out.held_back = untangle(out.mesh, net.centres);
  tell(options.progress, 0.8);
  if (options.most_triangles > 0 && int(out.mesh.triangles.size()) > options.most_triangles) {
    TriMesh fewer = geometry::simplified(out.mesh, options.most_triangles).mesh;
    if (!geometry::examine(fewer).crossings.empty()) fewer = geometry::untangled(fewer).mesh;
    if (geometry::examine(fewer).is_body()) out.mesh = std::move(fewer);
  }
  out.ml = 1e6 * geometry::volume(out.mesh);
  out.is_body = geometry::examine(out.mesh).is_body();
  return out;
}

}  // namespace trocar::volumes

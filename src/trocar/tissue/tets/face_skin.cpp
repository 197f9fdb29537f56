#include <algorithm>
#include <map>

#include <trocar/tissue/tets/cuttable_skin.hpp>
#include <trocar/tissue/tets/face_skin.hpp>

namespace trocar::tissue {
namespace {

using geometry::CuttableTets;
using geometry::Tet;

constexpr double kCurving = 0.75;  // of the way to the tangent planes; 3/4 as in the source

struct Face {
  int cell;
  std::array<int, 3> node;
  bool bare;
};

std::vector<Face> faces_of(const CuttableTets& b, std::span<const Tet> uncut) {
  std::vector<Face> faces;
  for (std::size_t c = 0; c < b.cells.size(); ++c)
    for (std::size_t f = 0; f < 4; ++f) {
      if (b.across[c][f] >= 0) continue;
      Face face{int(c), {}, uncut[c][f] >= 0};
      for (std::size_t k = 0; k < 3; ++k) face.node[k] = b.cells[c][std::size_t(kFaceCorners[f][k])];
      faces.push_back(face);
    }
  return faces;
}

/// Where the inside is bare the own surface does not bend towards its rim: both have the same straight edge there.
std::vector<std::uint8_t> rim_of(const CuttableTets& b, const std::vector<Face>& faces) {
  std::vector<std::uint8_t> rim(b.rest.size(), 0);
  for (const Face& f : faces)
    for (const int node : f.node) rim[std::size_t(node)] |= std::uint8_t(f.bare);
  return rim;
}

/// Normals of the body's own surface at its nodes.
std::vector<Vec3d> own_normals(const CuttableTets& b, const std::vector<Face>& faces) {
  std::vector<Vec3d> sum(b.rest.size(), Vec3d{});
  for (const Face& f : faces) {
    if (f.bare) continue;
    const auto x = [&](std::size_t k) { return b.rest[std::size_t(f.node[k])]; };
    const Vec3d n = cross(x(1) - x(0), x(2) - x(0));
    for (const int node : f.node) sum[std::size_t(node)] += n;
  }
  for (Vec3d& n : sum) n = normalised(n, Vec3d{0, 0, 0});
  return sum;
}

/// Where x lies in the cell: four weights with the sum 1.
std::array<double, 4> places_in(const CuttableTets& b, const Tet& cell, Vec3d x) {
  const auto r = [&](std::size_t k) { return b.rest[std::size_t(cell[k])]; };
  const Vec3d e1 = r(1) - r(0), e2 = r(2) - r(0), e3 = r(3) - r(0), d = x - r(0);
  const double six = dot(e1, cross(e2, e3));
  const double w1 = dot(d, cross(e2, e3)) / six, w2 = dot(e1, cross(d, e3)) / six, w3 = dot(e1, cross(e2, d)) / six;
  return {1 - w1 - w2 - w3, w1, w2, w3};
}

/// One vertex for all faces that meet in it, unless a cut's edge runs there.
using Key = std::pair<std::array<int, 6>, bool>;  // up to three nodes with how many parts of each; bare

Key key_of(const Face& f, const std::array<int, 3>& share) {
  std::array<std::pair<int, int>, 3> named;
  for (std::size_t k = 0; k < 3; ++k) named[k] = share[k] > 0 ? std::pair{f.node[k], share[k]} : std::pair{-1, 0};
  std::sort(named.begin(), named.end());
  Key key{{}, f.bare};
  for (std::size_t k = 0; k < 3; ++k) {
    key.first[2 * k] = named[k].first;
    key.first[2 * k + 1] = named[k].second;
  }
  return key;
}

class Builder {
 public:
  Builder(const CuttableTets& tets, std::span<const int> rows, int parts, const std::vector<Face>& faces)
      : b(tets), m_rows(rows), m_parts(parts), m_normals(own_normals(tets, faces)), m_rim(rim_of(tets, faces)) {}

  void add(const Face& f) {
    const auto vertex = [&](int i, int j) { return at(f, {m_parts - i - j, i, j}); };
    for (int i = 0; i < m_parts; ++i)
      for (int j = 0; i + j < m_parts; ++j) {
        out.skin.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)});
        if (i + j + 1 < m_parts)
          out.skin.triangles.push_back({vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
      }
  }

  FaceSkin out;

 private:
  int at(const Face& f, const std::array<int, 3>& share) {
    const auto [found, fresh] = m_vertex.insert({key_of(f, share), int(out.bare.size())});
    if (fresh) make(f, share);
    return found->second;
  }

  void make(const Face& f, const std::array<int, 3>& share) {
    Vec3d flat, towards, normal;
    std::array<float, 3> between;
    for (std::size_t k = 0; k < 3; ++k) {
      const double w = double(share[k]) / m_parts;
      flat += w * b.rest[std::size_t(f.node[k])];
      normal += w * m_normals[std::size_t(f.node[k])];
      between[k] = float(w);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (m_rim[std::size_t(f.node[k])]) continue;
      const Vec3d n = m_normals[std::size_t(f.node[k])];
      towards += double(share[k]) / m_parts * dot(b.rest[std::size_t(f.node[k])] - flat, n) * n;
    }
    const Vec3d x = f.bare ? flat : flat + kCurving * towards;
    const Tet& cell = b.cells[std::size_t(f.cell)];
    const std::array<double, 4> w = places_in(b, cell, x);
    SkinWeights weights = SkinWeights::at(cell[0], m_rows[std::size_t(cell[0])]);
    for (std::size_t k = 0; k < 4; ++k) {
      weights.node[k] = cell[k];
      weights.row[k] = m_rows[std::size_t(cell[k])];
      weights.weight[k] = float(w[k]);
    }
    out.skin.weights.push_back(weights);
    out.skin.rest.push_back(vec_cast<float>(x));
    out.skin.rest_normal.push_back(vec_cast<float>(normalised(normal, Vec3d{0, 0, 1})));
    out.bare.push_back(f.bare);
    out.corners.push_back(f.node);
    out.between.push_back(between);
  }

  const CuttableTets& b;
  std::span<const int> m_rows;
  int m_parts;
  std::vector<Vec3d> m_normals;
  std::vector<std::uint8_t> m_rim;
  std::map<Key, int> m_vertex;
};

}  // namespace

FaceSkin face_skin(const CuttableTets& tets, std::span<const Tet> uncut, std::span<const int> row_of_node, int parts) {
  const std::vector<Face> faces = faces_of(tets, uncut);
  Builder builder(tets, row_of_node, std::clamp(parts, 1, 8), faces);
  for (const Face& f : faces) builder.add(f);
  index_skin(builder.out.skin);
  return std::move(builder.out);
}

}  // namespace trocar::tissue

#include <algorithm>
#include <cmath>

#include <trocar/geometry/remesh/patch_work.hpp>
#include <trocar/numerics/conjugate_gradient.hpp>

namespace trocar::geometry {
namespace {

constexpr std::size_t kMostPatchFaces = 200'000;
constexpr int kRefineRounds = 24, kRelaxRounds = 20;

/// The cotangent of the angle at `apex`.
double cotangent(Vec3d apex, Vec3d a, Vec3d b) {
  const Vec3d u = a - apex, v = b - apex;
  const double sine = length(cross(u, v));
  return sine > 0 ? dot(u, v) / sine : 1e9;
}

/// What shall be small: some unknowns, each with its weight, and a constant.
struct FairRow {
  std::vector<std::pair<int, double>> terms;
  Vec3d constant{};
};

/// The unknowns for which the rows are as small as they can be. [least squares by conjugate gradients]
class FairSystem {
 public:
  FairSystem(std::vector<FairRow> rows, int unknowns) : m_rows(std::move(rows)), m_count(unknowns) {}

  std::vector<Vec3d> solve(std::vector<Vec3d> guess) const {
    std::vector<double> diagonal(m_count, 0.0), scratch(m_rows.size());
    for (const FairRow& row : m_rows)
      for (const auto& [i, w] : row.terms) diagonal[i] += w * w;
    numerics::ConjugateGradientWork work(m_count);
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> right(m_count, 0.0), x(m_count);
      for (const FairRow& row : m_rows)
        for (const auto& [i, w] : row.terms) right[i] -= w * row.constant[axis];
      for (int i = 0; i < m_count; ++i) x[i] = guess[i][axis];
      const auto apply = [&](const double* in, double* out) {
        for (std::size_t r = 0; r < m_rows.size(); ++r) {
          scratch[r] = 0;
          for (const auto& [i, w] : m_rows[r].terms) scratch[r] += w * in[i];
        }
        std::fill(out, out + m_count, 0.0);
        for (std::size_t r = 0; r < m_rows.size(); ++r)
          for (const auto& [i, w] : m_rows[r].terms) out[i] += w * scratch[r];
      };
      numerics::conjugate_gradient(apply, numerics::DiagonalPreconditioner{diagonal.data()}, right.data(), x.data(),
                                   m_count, {2000, 1e-7}, work);
      for (int i = 0; i < m_count; ++i) guess[i][axis] = x[i];
    }
    return guess;
  }

 private:
  std::vector<FairRow> m_rows;
  int m_count;
};

/// Numbers of the unknowns among the vertices; -1 of those that stay.
class FairRows {
 public:
  FairRows(const EditableMesh& mesh, const std::vector<int>& inner) : m_mesh(mesh), m_inner(inner) {
    m_number.assign(mesh.vertices(), -1);
    for (int i = 0; i < int(inner.size()); ++i) m_number[inner[i]] = i;
  }

  /// Every edge at an inner vertex: its two ends' difference.
  std::vector<FairRow> film() const {
    std::vector<FairRow> rows;
    std::vector<int> around;
    for (const int v : m_inner) {
      m_mesh.neighbours(v, around);
      for (const int w : around)
        if (m_number[w] < 0 || v < w) {
          rows.emplace_back();
          add(rows.back(), v, 1), add(rows.back(), w, -1);
        }
    }
    return rows;
  }

  /// Every vertex within and on the border: how far it is off the mean of those around it, near ones counting more.
  std::vector<FairRow> plate() const {
    std::vector<bool> wanted(m_number.size());
    std::vector<int> around;
    for (const int v : m_inner) {
      wanted[v] = true;
      m_mesh.neighbours(v, around);
      for (const int w : around) wanted[w] = true;
    }
    std::vector<FairRow> rows;
    for (int v = 0; v < int(wanted.size()); ++v) {
      if (!wanted[v]) continue;
      m_mesh.neighbours(v, around);
      double sum = 0;
      for (const int w : around) sum += weight(v, w);
      rows.emplace_back();
      add(rows.back(), v, -1);
      for (const int w : around) add(rows.back(), w, weight(v, w) / sum);
    }
    return rows;
  }

 private:
  const EditableMesh& m_mesh;
  const std::vector<int>& m_inner;
  std::vector<int> m_number;

  double weight(int v, int w) const { return 1 / std::max(length(m_mesh.place(v) - m_mesh.place(w)), 1e-30); }
  void add(FairRow& row, int v, double factor) const {
    if (m_number[v] >= 0)
      row.terms.emplace_back(m_number[v], factor);
    else
      row.constant += factor * m_mesh.place(v);
  }
};

}  // namespace

PatchWork::PatchWork(EditableMesh& mesh, std::vector<int> faces)
    : m_mesh(mesh), m_faces(std::move(faces)), m_in_patch(mesh.faces()), m_fineness(mesh.vertices()) {
  for (const int f : m_faces) m_in_patch[f] = true;
  std::vector<int> around;
  for (const int f : m_faces)
    for (const int v : m_mesh.face(f)) {
      if (m_fineness[v] > 0) continue;
      m_mesh.neighbours(v, around);
      double sum = 0;
      int count = 0;
      for (const int w : around) {
        const EditableMesh::Sides at = m_mesh.sides(v, w);
        if ((at.face[0] >= 0 && !m_in_patch[at.face[0]]) || (at.face[1] >= 0 && !m_in_patch[at.face[1]]))
          sum += edge_length(v, w), ++count;
      }
      m_fineness[v] = count > 0 ? sum / count : 0;
    }
}

double PatchWork::edge_length(int a, int b) const { return length(m_mesh.place(a) - m_mesh.place(b)); }

void PatchWork::refine() {
  for (int round = 0; round < kRefineRounds && split_coarse(); ++round)
    for (int i = 0; i < kRelaxRounds && relax(); ++i) {
    }
}

bool PatchWork::split_coarse() {
  bool any = false;
  const std::size_t before = m_faces.size();
  for (std::size_t i = 0; i < before && m_faces.size() < kMostPatchFaces; ++i) {
    const auto [a, b, c] = m_mesh.face(m_faces[i]);
    const Vec3d middle = (m_mesh.place(a) + m_mesh.place(b) + m_mesh.place(c)) / 3.0;
    const double fineness = (m_fineness[a] + m_fineness[b] + m_fineness[c]) / 3;
    bool coarse = true;
    for (const int v : {a, b, c}) {
      const double reach = std::sqrt(2.0) * length(middle - m_mesh.place(v));
      coarse = coarse && reach > fineness && reach > m_fineness[v];
    }
    if (!coarse) continue;
    any = true;
    m_inner.push_back(m_mesh.split_face(m_faces[i], middle));
    m_fineness.push_back(fineness);
    for (const int f : {m_mesh.faces() - 2, m_mesh.faces() - 1}) m_faces.push_back(f);
    m_in_patch.resize(m_mesh.faces(), true);
  }
  return any;
}

/// Flips edges within the patch whose opposite angles are together more than a half turn.
bool PatchWork::relax() {
  bool any = false;
  for (const int f : m_faces)
    for (int k = 0; k < 3; ++k) {
      const int a = m_mesh.face(f)[k], b = m_mesh.face(f)[(k + 1) % 3];
      const EditableMesh::Sides at = m_mesh.sides(a, b);
      if (at.count != 2 || !m_in_patch[at.face[0]] || !m_in_patch[at.face[1]]) continue;
      const int c = m_mesh.opposite(at.face[0], a, b), d = m_mesh.opposite(at.face[1], a, b);
      const double sum = cotangent(m_mesh.place(c), m_mesh.place(a), m_mesh.place(b)) +
                         cotangent(m_mesh.place(d), m_mesh.place(a), m_mesh.place(b));
      if (sum > -1e-9 || !m_mesh.can_flip(a, b)) continue;
      m_mesh.flip(a, b);
      any = true;
    }
  return any;
}

void PatchWork::fair(PatchShape shape) {
  if (m_inner.empty()) return;
  const FairRows rows(m_mesh, m_inner);
  std::vector<Vec3d> places;
  for (const int v : m_inner) places.push_back(m_mesh.place(v));
  const FairSystem system(shape == PatchShape::stretched ? rows.film() : rows.plate(), int(m_inner.size()));
  places = system.solve(std::move(places));
  for (std::size_t i = 0; i < m_inner.size(); ++i) m_mesh.move(m_inner[i], places[i]);
}

}  // namespace trocar::geometry

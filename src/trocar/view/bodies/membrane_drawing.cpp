#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/view/base/fold_pattern.hpp>
#include <trocar/view/bodies/membrane_drawing.hpp>

namespace trocar::view {
namespace {

constexpr int kFine = 3;                    // drawn cells along each side of a cell of the body
constexpr double kMembraneRipple = 0.0004;  // [m] of a fold that is slack
constexpr double kMembraneFaded = 4;        // columns over which an end runs out
constexpr double kMembraneRoot = 0.09;      // of its width, over which its root is lost in what it hangs on
constexpr double kElsewhere = 0.0173;       // [m] one fold's pattern from the next one's
constexpr float kMembraneRagged = 0.0005f;  // [m] how uneven a torn edge is
constexpr std::uint8_t kTornPale = 44;      // it is whitish

/// Catmull-Rom between b and c.
Vec3d between(Vec3d a, Vec3d b, Vec3d c, Vec3d d, double t) {
  const double u = 1 - t;
  const Vec3d at_b = 0.5 * (c - a), at_c = 0.5 * (d - b);
  return (u * u * (1 + 2 * t)) * b + (t * t * (3 - 2 * t)) * c + (u * u * t) * at_b - (t * t * u) * at_c;
}

/// A point on the line of `count` points that at(i) gives, `fine` steps from the first, kFine steps a point.
template <class At>
Vec3d on_line(int fine, int count, At&& at) {
  const int i = std::min(fine / kFine, count - 2);
  const Vec3d b = at(i), c = at(i + 1);
  const Vec3d a = i > 0 ? at(i - 1) : b - (c - b), d = i + 2 < count ? at(i + 2) : c + (c - b);
  return between(a, b, c, d, double(fine - i * kFine) / kFine);
}

}  // namespace

MembraneDrawing::MembraneDrawing(const sim::Model& model, int membrane, render::Backend& backend, const Detail& detail)
    : m_membrane(&model.membranes[std::size_t(membrane)]),
      m_look(&look(model, m_membrane->look)),
      m_index(membrane),
      m_columns((m_membrane->sheet.columns - 1) * kFine + 1),
      m_rows((m_membrane->sheet.rows - 1) * kFine + 1),
      m_torn(m_membrane->sheet.triangles.size(), 0),
      m_marks(model, BodyId::membrane(std::size_t(membrane)), flat_places()) {
  const tissue::MembraneState rest = tissue::rest_state(m_membrane->sheet);
  m_buffer.positions.resize(std::size_t(m_columns) * std::size_t(m_rows));
  place(rest);
  lay_pattern();
  connect(m_torn);
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
  coarsen(m_buffer, detail, kBends);
  m_mesh = OwnedMesh(backend, m_buffer.data());
}

std::vector<Vec3d> MembraneDrawing::flat_places() const {
  const tissue::MembraneModel& sheet = m_membrane->sheet;
  const auto node = [&](int c, int r) { return sheet.network.rest[std::size_t(r * sheet.columns + c)]; };
  std::vector<Vec3d> places;
  for (int r = 0; r < m_rows; ++r)
    for (int c = 0; c < m_columns; ++c) {
      const int i = std::min(c / kFine, sheet.columns - 2), j = std::min(r / kFine, sheet.rows - 2);
      const double u = double(c - i * kFine) / kFine, v = double(r - j * kFine) / kFine;
      places.push_back((1 - v) * ((1 - u) * node(i, j) + u * node(i + 1, j)) +
                       v * ((1 - u) * node(i, j + 1) + u * node(i + 1, j + 1)));
    }
  return places;
}

/// Rest coordinates: those of a fold with an arcade are its own, others' are where it is drawn.
void MembraneDrawing::lay_pattern() {
  m_buffer.rest = m_buffer.positions;
  m_buffer.paint.clear();
  const bool own = m_look->material.arcade;
  for (int r = 0; r < m_rows; ++r)
    for (int c = 0; c < m_columns; ++c) {
      const double s = m_membrane->from + (m_membrane->to - m_membrane->from) * c / (m_columns - 1);
      const double v = double(r) / (m_rows - 1);
      if (own) m_buffer.rest[std::size_t(r * m_columns + c)] = fold_rest(s + kElsewhere * m_index, v);
      Paint paint = fold_paint(s + kElsewhere * m_index, v);
      const double beside = double(std::min(c, m_columns - 1 - c)) / kMembraneFaded;  // its ends are not seen as edges
      const double rooted = smooth(1, 1 - kMembraneRoot, v);                          // nor is its root
      paint.openness = to_byte(paint.openness / 255.0 * smooth(-0.1, 1, beside) * (0.15 + 0.85 * rooted));
      paint.tint = to_byte(paint.tint / 255.0 * smooth(0, 1, beside));
      m_buffer.paint.push_back(paint);
    }
}

/// All cells but those that are cut open; what borders on these is an edge.
void MembraneDrawing::connect(const std::vector<std::uint8_t>& torn) {
  m_buffer.indices.clear();
  m_edge.assign(m_buffer.positions.size(), 0);
  for (int r = 0; r + 1 < m_rows; ++r)
    for (int c = 0; c + 1 < m_columns; ++c) {
      const std::size_t cell = std::size_t(r / kFine * (m_membrane->sheet.columns - 1) + c / kFine);
      const auto a = std::uint32_t(r * m_columns + c), b = a + 1, d = a + std::uint32_t(m_columns);
      if (torn[2 * cell] || torn[2 * cell + 1]) {
        for (const std::uint32_t corner : {a, b, d, d + 1}) m_edge[corner] = 1;
        continue;
      }
      m_buffer.quad(a, b, d + 1, d);
    }
}

void MembraneDrawing::place(const tissue::MembraneState& state) {
  const tissue::MembraneModel& sheet = m_membrane->sheet;
  const int columns = sheet.columns, rows = sheet.rows;
  m_node.resize(std::size_t(columns) * std::size_t(rows));
  m_between.resize(std::size_t(m_columns) * std::size_t(rows));
  for (int i = 0; i < sheet.nodes(); ++i) m_node[std::size_t(i)] = position(sheet.network, state.network, i);
  std::vector<double> width;
  for (int c = 0; c < columns; ++c)
    width.push_back(length(m_node[std::size_t(c)] - m_node[std::size_t((rows - 1) * columns + c)]));
  if (m_rest_width.empty()) m_rest_width = width;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < m_columns; ++c)
      m_between[std::size_t(r * m_columns + c)] =
          on_line(c, columns, [&](int i) { return m_node[std::size_t(r * columns + i)]; });
  for (int c = 0; c < m_columns; ++c) {
    const std::size_t near = std::size_t(std::min((c + kFine / 2) / kFine, columns - 1));
    const double slack = 1 - smooth(1.0, 1.35, width[near] / std::max(m_rest_width[near], 1e-6));
    const double s = m_membrane->from + (m_membrane->to - m_membrane->from) * c / (m_columns - 1);
    const int other = c + 1 < m_columns ? c + 1 : c - 1;
    const Vec3d down = m_between[std::size_t((rows - 1) * m_columns + c)] - m_between[std::size_t(c)];
    const Vec3d along = (other > c ? 1.0 : -1.0) * (m_between[std::size_t(other)] - m_between[std::size_t(c)]);
    const Vec3d across = normalised(cross(along, down));
    for (int r = 0; r < m_rows; ++r) {
      const double v = double(r) / (m_rows - 1), belly = 4 * v * (1 - v);
      const double ripple =
          kMembraneRipple * belly * (0.2 + 0.8 * slack) *
          (std::sin(portable::two_pi * s / 0.011 + 2.1 * v) + 0.2 * std::sin(portable::two_pi * s / 0.0047 - 3 * v));
      const Vec3d p = on_line(r, rows, [&](int i) { return m_between[std::size_t(i * m_columns + c)]; });
      m_buffer.positions[std::size_t(r * m_columns + c)] = vec_cast<float>(p + ripple * across);
    }
  }
}

/// A torn edge is uneven and curls.
void MembraneDrawing::fray() {
  for (std::size_t i = 0; i < m_edge.size(); ++i)
    if (m_edge[i])
      for (int k = 0; k < 3; ++k) (&m_buffer.positions[i].x)[k] += kMembraneRagged * (2 * float(varied(int(i), k)) - 1);
}

void MembraneDrawing::update(const sim::State& state) {
  place(state.membranes[std::size_t(m_index)]);
  const std::vector<std::uint8_t>& torn = state.torn[std::size_t(m_index)];
  const bool changed = torn != m_torn;
  if (changed) {
    m_torn = torn;
    m_buffer.coarser.clear();
    connect(torn);
  }
  fray();
  const bool burnt = m_marks.update(state) || changed;
  for (std::size_t i = 0; burnt && i < m_buffer.paint.size(); ++i)
    m_buffer.paint[i].burn = std::max(m_marks.burn(i), m_edge[i] ? kTornPale : std::uint8_t(0));
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
  if (changed)
    m_mesh.replace(m_buffer.data());
  else if (burnt)
    m_mesh.update(m_buffer);
  else
    m_mesh.move(m_buffer.positions, m_buffer.normals);
}

}  // namespace trocar::view

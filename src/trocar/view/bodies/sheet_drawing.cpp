#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/view/base/fold_pattern.hpp>
#include <trocar/view/base/looks.hpp>
#include <trocar/view/bodies/sheet_drawing.hpp>

namespace trocar::view {
namespace {

constexpr int kSheetRows = 11;           // strand to base
constexpr double kSheetStep = 0.0016;    // [m] between columns
constexpr double kTear = 0.24;           // of the width, how deep a cut's gap goes
constexpr double kTearReach = 0.012;     // [m] along the strand on either side
constexpr double kSheetRagged = 0.0011;  // [m] how uneven a torn edge is
constexpr double kPaleEdge = 0.22;       // of kTearReach: whitish beside a tear
constexpr double kSag = 0.10;            // of the width, where the fold is as drawn
constexpr double kSheetRipple = 0.0006;  // [m]
constexpr std::size_t kSheetFaded = 6;   // columns over which a free edge runs out
constexpr int kBlended = 14;             // columns over which it takes on the colour of a wall that it continues to
constexpr int kMarginSteps = 4;          // columns between an edge and the organ it runs out on
constexpr double kMarginFar = 0.012;     // [m] to that
constexpr int kEvenPasses = 4;
constexpr double kTopOffset = 0.3;       // radii of the strand: there the fold begins, well within it
constexpr double kCrescent = 0.3;        // of the width: the margin's free border starts this far from the strand
constexpr double kLigamentNear = 0.03;   // [m] from where the margin's border would be free
constexpr double kLigamentAside = 0.12;  // of the ligament: how much further along it the border arrives
constexpr int kLigamentPoints = 8;
constexpr int kSheetHemRows = 7;    // from a base in the air to the wall
constexpr double kHemFar = 0.06;    // [m] at most
constexpr double kHemSunk = 0.002;  // [m] below the wall

/// How much of the sheet there is beside a cut: it frays out into a ragged, soft edge and not along a line.
double whole_beside_tear(double gap, double s, double v) {
  const double ragged =
      0.16 + 0.1 * std::sin(portable::two_pi * v / 0.13 + 40 * s) + 0.06 * std::sin(portable::two_pi * v / 0.051);
  return 1 - smooth(ragged + 0.25, ragged, gap) * smooth(1.2 * kTear, 0.6 * kTear, v);
}

/// The hem is lost on the wall, along no line: sooner here, later there, and soonest at its ends.
double hem_openness(std::size_t column, std::size_t columns, int row) {
  const double t = double(row + 1) / kSheetHemRows;
  const double beside = double(std::min(column, columns - 1 - column)) / (2.0 * double(kSheetFaded));
  const double uneven = 0.12 * std::sin(0.9 * double(column)) + 0.1 * std::sin(0.37 * double(column) + 2);
  const double lost = smooth(0.3 + uneven, 0.92 + uneven, t);
  return (1 - lost) * (1 - smooth(0, 0.5, t) * smooth(1, 0, beside));
}

}  // namespace

SheetDrawing::SheetDrawing(const sim::Model& model, int sheet, render::Backend& backend, const Detail& detail,
                           const WallSurface* walls)
    : m_model(&model),
      m_sheet(&model.drawn_folds[std::size_t(sheet)]),
      m_body(&model.strand_bodies[std::size_t(m_sheet->strand)]),
      m_base(m_sheet->base.size()) {
  const sim::State rest = sim::initial_state(model);
  double way = 0;
  for (std::size_t i = 0; i < m_sheet->base.size(); ++i) {
    if (i > 0) way += length(base_point(i, rest) - base_point(i - 1, rest));
    m_base_share.push_back(way);
  }
  for (double& share : m_base_share) share /= std::max(way, 1e-9);
  const auto strand = std::size_t(m_sheet->strand);
  lay_out(pieces_of(*m_body, tissue::rest_state(m_body->model).alive, {}, int(strand)));
  place(rest);
  find_ends(walls ? *walls : WallSurface(model));
  connect();
  m_rest_width.clear();
  place(rest);
  lay_pattern();
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
  coarsen(m_buffer, detail, kBends);
  m_mesh = OwnedMesh(backend, m_buffer.data());
}

void SheetDrawing::lay_out(std::vector<StrandPiece> pieces) {
  m_pieces = std::move(pieces);
  m_columns.clear();
  for (int i = 0; i < int(m_pieces.size()); ++i) {
    const StrandPiece& p = m_pieces[std::size_t(i)];
    const double from = std::max(p.from, m_sheet->from), to = std::min(p.to, m_sheet->to);
    if (to <= from) continue;
    const int steps = std::max(1, int(std::ceil((to - from) / kSheetStep)));
    const bool follows_cut = p.cut_start && from == p.from && !m_columns.empty();
    if (follows_cut) m_columns.back().twin = int(m_columns.size());
    for (int k = 0; k <= steps; ++k) {
      Column c{i, from + (to - from) * k / steps, -1, 1};
      if (p.cut_start) c.gap = std::min(c.gap, (c.s - p.from) / kTearReach);
      if (p.cut_end) c.gap = std::min(c.gap, (p.to - c.s) / kTearReach);
      if (k == 0 && follows_cut) c.twin = int(m_columns.size()) - 1;
      m_columns.push_back(c);
    }
  }
  m_rest_width.clear();
  connect();
}

void SheetDrawing::connect() {
  m_buffer.paint.clear();
  m_buffer.indices.clear();
  m_buffer.positions.clear();
  for (std::size_t c = 0; c < m_columns.size(); ++c)
    for (int r = 0; r < kSheetRows; ++r) {
      const double v = double(r) / (kSheetRows - 1);
      const double near = std::min(v, 1 - v);
      const std::size_t left = m_columns.size() - 1 - c;  // a free edge is not seen as one
      const double end = beyond(true) == 0 && left < kSheetFaded ? double(left) / kSheetFaded : 1;
      const double thin = m_hem.empty() ? near : v;  // continues below its base
      // Pale where it is torn, and not beyond that: paint of burns hides how sheer a fold is.
      const double whole = whole_beside_tear(m_columns[c].gap, m_columns[c].s, v);
      const double torn = smooth(kTear, 0.6 * kTear, v) * smooth(kPaleEdge, 0.5 * kPaleEdge, m_columns[c].gap);
      m_buffer.add({}, {to_byte(end * whole * (0.62 + 0.38 * smooth(0, 0.25, thin))), 0,
                        to_byte(0.17 * torn * smooth(0.6, 1, whole)), to_byte(wall_tint(left, v))});
    }
  for (std::size_t c = 0; c + 1 < m_columns.size(); ++c) {
    if (m_columns[c].twin == int(c) + 1) continue;
    join_rows(m_buffer, std::uint32_t(c * kSheetRows), std::uint32_t((c + 1) * kSheetRows), kSheetRows, false);
  }
  for (const bool at_end : {false, true}) connect_end(at_end);
  m_hem_first = m_buffer.size();
  if (m_hem.empty()) return;
  for (std::size_t c = 0; c < m_columns.size(); ++c)
    for (int r = 0; r < kSheetHemRows; ++r) m_buffer.add({}, {to_byte(hem_openness(c, m_columns.size(), r)), 0, 0, 0});
  const auto at = [this](std::size_t c, int r) {
    return std::uint32_t(r == 0 ? c * kSheetRows + kSheetRows - 1
                                : m_hem_first + c * kSheetHemRows + std::size_t(r - 1));
  };
  for (std::size_t c = 0; c + 1 < m_columns.size(); ++c)
    for (int r = 0; r < kSheetHemRows && m_columns[c].twin != int(c) + 1; ++r)
      m_buffer.quad(at(c, r), at(c, r + 1), at(c + 1, r + 1), at(c + 1, r));
}

/// Of a sheet that continues to a wall: as much of that one's colour as what continues has where it begins.
double SheetDrawing::wall_tint(std::size_t columns_left, double v) const {
  if (m_onto[1].strand < 0) return 0;
  return SheetCrescent::paint(0, v, true).tint / 255.0 * smooth(double(kBlended), 0, double(columns_left));
}

/// Columns beyond an end, and their cells.
void SheetDrawing::connect_end(bool at_end) {
  const int steps = beyond(at_end);
  m_beyond_first[at_end] = m_buffer.size();
  std::uint32_t before = at_end ? std::uint32_t((m_columns.size() - 1) * kSheetRows) : 0;
  for (int k = 1; k <= steps; ++k) {
    const std::uint32_t row = m_buffer.size();
    for (int r = 0; r < kSheetRows; ++r)
      m_buffer.add({}, m_crescent[at_end]
                           ? SheetCrescent::paint(k, double(r) / (kSheetRows - 1), m_onto[at_end].strand >= 0)
                           : Paint{to_byte(1 - double(k) / kMarginSteps), 0, 0, 0});
    join_rows(m_buffer, at_end ? before : row, at_end ? row : before, kSheetRows, false);
    before = row;
  }
}

/// A base that nothing carries hangs in the air: below it the sheet continues to the wall and is lost there.
void SheetDrawing::find_hem(const WallSurface& walls) {
  m_hem.clear();
  for (const interactions::MaterialPoint& b : m_sheet->base)
    if (!b.in_space()) return;
  for (std::size_t c = 0; c < m_columns.size(); ++c) {
    const Vec3d top = vec_cast<double>(m_buffer.positions[c * kSheetRows]),
                base = vec_cast<double>(m_buffer.positions[c * kSheetRows + kSheetRows - 1]);
    m_hem.push_back(base + 0.6 * (base - top));
  }
  for (int pass = 0; pass < 10; ++pass)
    for (std::size_t c = 1; c + 1 < m_hem.size(); ++c) m_hem[c] = 0.5 * m_hem[c] + 0.25 * (m_hem[c - 1] + m_hem[c + 1]);
  for (std::size_t c = 0; c < m_hem.size(); ++c) {
    const WallSurface::Place wall = walls.nearest(m_hem[c]);
    if (!wall.there || length(wall.point - m_hem[c]) > kHemFar) {
      m_hem.clear();
      return;
    }
    m_hem[c] = wall.point - kHemSunk * wall.normal;
  }
}

void SheetDrawing::place_hem() {
  for (std::size_t c = 0; c < m_columns.size(); ++c) {
    const Vec3d before = vec_cast<double>(m_buffer.positions[c * kSheetRows + kSheetRows - 2]),
                base = vec_cast<double>(m_buffer.positions[c * kSheetRows + kSheetRows - 1]);
    // The hem belongs to a place on the strand, not to a column: a cut may have added some.
    const double share = m_columns.size() > 1 ? double(c) / double(m_columns.size() - 1) : 0;
    const Vec3d to = m_hem[std::min(m_hem.size() - 1, std::size_t(share * double(m_hem.size() - 1) + 0.5))];
    const Vec3d leaves = (0.5 * length(to - base)) * normalised(base - before);
    for (int r = 0; r < kSheetHemRows; ++r) {
      const double t = double(r + 1) / kSheetHemRows, u = 1 - t;
      m_buffer.positions[m_hem_first + c * kSheetHemRows + std::size_t(r)] =
          vec_cast<float>((u * u * (1 + 2 * t)) * base + (t * t * (3 - 2 * t)) * to + (u * u * t) * leaves);
    }
  }
}

/// What the sheet runs out on at either end and below its base.
void SheetDrawing::find_ends(const WallSurface& walls) {
  for (const bool at_end : {false, true}) {
    find_margin(at_end);
    if (m_margin[at_end].empty()) find_crescent(at_end, walls);
  }
  find_hem(walls);
}

/// Columns beyond the last one of an end.
int SheetDrawing::beyond(bool at_end) const {
  if (m_crescent[at_end]) return SheetCrescent::kSteps;
  return m_margin[at_end].empty() ? 0 : kMarginSteps;
}

/// Points of the strand from the sheet's end on, where its border lies.
std::vector<Vec3d> SheetDrawing::beside(bool at_end, const StrandCurve& curve) const {
  const std::size_t c = at_end ? m_columns.size() - 1 : 0;
  const Column& column = m_columns[c];
  const StrandPiece& piece = m_pieces[std::size_t(column.piece)];
  const Vec3d top = vec_cast<double>(m_buffer.positions[c * kSheetRows]);
  const Vec3d offset = top - curve.at(column.piece, column.s).point;
  std::vector<Vec3d> line;
  for (int k = 0; k <= SheetCrescent::kSteps; ++k) {
    const double far = SheetCrescent::kAlong * k / SheetCrescent::kSteps;
    const double s = std::clamp(column.s + (at_end ? far : -far), piece.from, piece.to);
    line.push_back(curve.at(column.piece, s).point + offset);
  }
  return line;
}

/// The nearest one that goes from an organ to the wall, and that the sheet does not hang on already.
SheetDrawing::Ligament SheetDrawing::ligament_near(Vec3d tip) const {
  Ligament best;
  double nearest = kLigamentNear;
  for (int k = 0; k < int(m_model->strands.size()); ++k) {
    const sim::StrandAnatomy& strand = m_model->strands[std::size_t(k)];
    const auto carries = [k](const interactions::MaterialPoint& b) {
      return b.body == BodyId::maybe(BodyKind::strand, k);
    };
    if (k == m_sheet->strand || std::any_of(m_sheet->base.begin(), m_sheet->base.end(), carries)) continue;
    if (strand.start.kind != sim::StrandEndModel::hosted || strand.end.kind != sim::StrandEndModel::fixed) continue;
    const interactions::StrandBody& body = m_model->strand_bodies[std::size_t(k)];
    for (std::size_t n = 0; n < body.model.rest.size(); ++n) {
      const double far = length(body.model.rest[n] - tip);
      if (far >= nearest) continue;
      nearest = far;
      best = {k, std::min(body.arc[n] + kLigamentAside * body.length(), 0.7 * body.length())};
    }
  }
  return best;
}

std::vector<Vec3d> SheetDrawing::ligament_points(bool at_end, const sim::State& state) const {
  std::vector<Vec3d> points;
  const Ligament& onto = m_onto[at_end];
  if (onto.strand < 0) return points;
  const auto strand = std::size_t(onto.strand);
  const interactions::StrandBody& body = m_model->strand_bodies[strand];
  for (int i = 0; i < kLigamentPoints; ++i) {
    const double s = onto.from + (body.length() - onto.from) * i / (kLigamentPoints - 1);
    points.push_back(point_at(body, state.strands[strand], place_at(body, s)));
  }
  return points;
}

void SheetDrawing::find_crescent(bool at_end, const WallSurface& walls) {
  const sim::State rest = sim::initial_state(*m_model);
  const StrandCurve curve(*m_body, rest.strands[std::size_t(m_sheet->strand)], m_pieces);
  const std::size_t c = at_end ? m_columns.size() - 1 : 0;
  const std::vector<Vec3d> strand = beside(at_end, curve);
  m_onto[at_end] = ligament_near(strand.back());
  SheetCrescent crescent(vec_cast<double>(m_buffer.positions[c * kSheetRows + kSheetRows - 1]), strand,
                         ligament_points(at_end, rest), walls);
  if (crescent.there())
    m_crescent[at_end] = std::move(crescent);
  else
    m_onto[at_end] = {};
}

void SheetDrawing::find_margin(bool at_end) {
  const std::size_t c = at_end ? m_columns.size() - 1 : 0, inner = at_end ? c - 1 : 1;
  std::vector<Margin> margin;
  for (std::size_t r = 0; r < kSheetRows; ++r) {
    const std::size_t from = std::max(r, std::size_t(kCrescent * kSheetRows));
    const Vec3d p = vec_cast<double>(m_buffer.positions[c * kSheetRows + from]);
    const Vec3d out = normalised(p - vec_cast<double>(m_buffer.positions[inner * kSheetRows + from]));
    double nearest = kMarginFar;
    Margin best;
    for (int organ = 0; organ < m_model->organs(); ++organ) {
      const tissue::Skin& skin = m_model->skin(organ);
      for (std::size_t i = 0; i < skin.rest.size(); ++i) {
        if (!skin.at_surface(int(i))) continue;
        const Vec3d d = vec_cast<double>(skin.rest[i]) - p;
        const double far = length(d);
        if (far >= nearest || dot(d, out) < 0.2 * far) continue;
        nearest = far;
        best = {organ, int(i)};
      }
    }
    if (best.vertex >= 0) margin.push_back(best);
  }
  if (margin.size() == kSheetRows) m_margin[at_end] = margin;
}

void SheetDrawing::place_margin(const sim::State& state, bool at_end) {
  const std::size_t edge = (at_end ? m_columns.size() - 1 : 0) * kSheetRows, first = m_beyond_first[at_end];
  for (std::size_t r = 0; r < kSheetRows; ++r) {
    const Margin& m = m_margin[at_end][r];
    const Vec3d to = tissue::skin_point(nodes_of(*m_model, state, m.organ), m_model->skin(m.organ), m.vertex);
    const Vec3f from = m_buffer.positions[edge + r], step = vec_cast<float>(to) - from;
    for (int k = 1; k <= kMarginSteps; ++k)
      m_buffer.positions[first + std::size_t(k - 1) * kSheetRows + r] = from + (float(k) / kMarginSteps) * step;
  }
}

void SheetDrawing::place_crescent(const sim::State& state, const StrandCurve& curve, bool at_end) {
  const std::size_t edge = (at_end ? m_columns.size() - 1 : 0) * kSheetRows;
  const std::span<Vec3f> all(m_buffer.positions);
  const std::size_t inner = at_end ? edge - kSheetRows : edge + kSheetRows;
  m_crescent[at_end]->place(all.subspan(edge, kSheetRows), all.subspan(inner, kSheetRows), beside(at_end, curve),
                            ligament_points(at_end, state),
                            all.subspan(m_beyond_first[at_end], std::size_t(SheetCrescent::kSteps) * kSheetRows));
}

Vec3d SheetDrawing::base_point(std::size_t i, const sim::State& state) const {
  return place_of(sim::bodies_of(*m_model, state), m_sheet->base[i]);
}

/// Rest coordinates: those of a fold with an arcade are its own, others' are where it is drawn.
void SheetDrawing::lay_pattern() {
  m_buffer.rest = m_buffer.positions;
  if (!look(*m_model, m_sheet->look).material.arcade) return;
  for (std::size_t i = 0; i < m_hem_first; ++i) {
    const std::size_t c = i / kSheetRows;
    const double v = double(i % kSheetRows) / (kSheetRows - 1);
    const bool inside = c < m_columns.size(), first = !inside && i < m_beyond_first[1];
    const std::size_t beyond = inside ? 0 : 1 + c - m_beyond_first[first ? 0 : 1] / kSheetRows;
    const double edge = inside ? m_columns[c].s : first ? m_columns.front().s : m_columns.back().s;
    const double s = edge + (first ? -1.0 : 1.0) * kSheetStep * double(beyond);
    m_buffer.rest[i] = fold_rest(s, v);
    if (beyond > 0) continue;
    const std::uint8_t torn = m_buffer.paint[i].burn;
    m_buffer.paint[i] = fold_paint(s, v);
    m_buffer.paint[i].burn = torn;
  }
}

/// Catmull-Rom through the base points.
Vec3d SheetDrawing::base_at(double share) const {
  const std::size_t n = m_base.size();
  if (n == 1) return m_base[0];
  std::size_t i = 0;
  while (i + 2 < n && m_base_share[i + 1] < share) ++i;
  const double h = std::max(m_base_share[i + 1] - m_base_share[i], 1e-9);
  const double t = std::clamp((share - m_base_share[i]) / h, 0.0, 1.0), u = 1 - t;
  const Vec3d a = m_base[i], b = m_base[i + 1];
  const Vec3d da = i > 0 ? 0.5 * (b - m_base[i - 1]) : b - a, db = i + 2 < n ? 0.5 * (m_base[i + 2] - a) : b - a;
  return (u * u * (1 + 2 * t)) * a + (t * t * (3 - 2 * t)) * b + (u * u * t) * da - (t * t * u) * db;
}

void SheetDrawing::place(const sim::State& state) {
  for (std::size_t i = 0; i < m_base.size(); ++i) m_base[i] = base_point(i, state);
  const StrandCurve curve(*m_body, state.strands[std::size_t(m_sheet->strand)], m_pieces);
  std::vector<Vec3d> top(m_columns.size()), base(m_columns.size()), along(m_columns.size());
  std::vector<Vec3d> beside(m_columns.size());  // from the strand's middle to where the fold begins
  for (std::size_t c = 0; c < m_columns.size(); ++c) {
    const Column& column = m_columns[c];
    base[c] = base_at((column.s - m_sheet->from) / std::max(m_sheet->to - m_sheet->from, 1e-9));
    const CurveFrame f = curve.at(column.piece, column.s);
    const double radius = m_body->model.radius[std::size_t(place_at(*m_body, column.s).element)];
    const Vec3d down = base[c] - f.point, across = down - dot(down, f.tangent) * f.tangent;
    // Where a strand runs away from its base, that says little of which side the fold is on.
    const double sure = smooth(0.1, 0.45, length(across) / std::max(length(down), 1e-6));
    beside[c] = kTopOffset * radius * sure * normalised(across, f.normal);
    top[c] = f.point;
    along[c] = f.tangent;
  }
  even_out(beside);
  for (std::size_t c = 0; c < m_columns.size(); ++c) top[c] += beside[c];
  const bool first = m_rest_width.empty();
  for (std::size_t c = 0; c < m_columns.size(); ++c) {
    if (first) m_rest_width.push_back(length(top[c] - base[c]));
    place_column(c, top[c], base[c], cross(along[c], normalised(base[c] - top[c])));
  }
  for (std::size_t c = 0; c + 1 < m_columns.size(); ++c)
    if (m_columns[c].twin == int(c) + 1) close_tear(c);
  for (const bool at_end : {false, true})
    if (m_crescent[at_end])
      place_crescent(state, curve, at_end);
    else if (!m_margin[at_end].empty())
      place_margin(state, at_end);
  if (!m_hem.empty()) place_hem();
}

/// Neighbours on the same piece even each other out.
void SheetDrawing::even_out(std::vector<Vec3d>& of_columns) const {
  std::vector<Vec3d> old;
  for (int pass = 0; pass < kEvenPasses; ++pass) {
    old = of_columns;
    for (std::size_t c = 1; c + 1 < old.size(); ++c)
      if (m_columns[c - 1].piece == m_columns[c + 1].piece)
        of_columns[c] = 0.4 * old[c] + 0.3 * (old[c - 1] + old[c + 1]);
  }
}

/// At a cut the two sides part near the strand and are one below: rows go over from their own shape to the mean, and
/// the columns nearby follow.
void SheetDrawing::close_tear(std::size_t c) {
  for (std::size_t r = 0; r < kSheetRows; ++r) {
    const Vec3f a = m_buffer.positions[c * kSheetRows + r], b = m_buffer.positions[(c + 1) * kSheetRows + r];
    const float joined = float(smooth(0, kTear, double(r) / (kSheetRows - 1)));
    const Vec3f half = (0.5f * joined) * (b - a);
    const auto moved = [&](std::size_t k, Vec3f by) {
      m_buffer.positions[k * kSheetRows + r] += float(smooth(1, 0, m_columns[k].gap)) * by;
    };
    for (std::size_t k = c + 1; k-- > 0 && m_columns[k].piece == m_columns[c].piece;) moved(k, half);
    for (std::size_t k = c + 1; k < m_columns.size() && m_columns[k].piece == m_columns[c + 1].piece; ++k)
      moved(k, -half);
    // Torn, not cut with a ruler: it draws back here, a shred stands there.
    const Vec3f apart = normalised(b - a, Vec3f{});
    for (const std::size_t k : {c, c + 1}) {
      const double shred = varied(int(k), int(r)) - 0.35 * (1 + std::sin(2.3 * double(r)));
      m_buffer.positions[k * kSheetRows + r] +=
          (float(kSheetRagged * shred) * (1 - joined) * (k == c ? 1.0f : -1.0f)) * apart;
    }
  }
}

void SheetDrawing::place_column(std::size_t c, Vec3d top, Vec3d base, Vec3d across) {
  const double width = length(top - base);
  const double slack = 1 - smooth(0.98, 1.25, width / std::max(m_rest_width[c], 1e-6));
  const Vec3d sag = slack * kSag * width * normalised(m_model->gravity, Vec3d{0, 0, -1});
  const double s = m_columns[c].s;
  for (std::size_t r = 0; r < kSheetRows; ++r) {
    const double v = double(r) / (kSheetRows - 1), belly = 4 * v * (1 - v);
    const double ripple =
        kSheetRipple * belly * (0.35 + slack) *
        (std::sin(portable::two_pi * s / 0.011 + 2.1 * v) + 0.6 * std::sin(portable::two_pi * s / 0.0047 - 3 * v));
    const Vec3d p = top + v * (base - top) + (belly * (0.6 + 0.4 * v)) * sag + ripple * across;
    m_buffer.positions[c * kSheetRows + r] = vec_cast<float>(p);
  }
}

void SheetDrawing::update(const sim::State& state) {
  const auto strand = std::size_t(m_sheet->strand);
  std::vector<StrandPiece> pieces =
      pieces_of(*m_body, state.strands[strand].alive, {state.cuts.data(), std::size_t(state.cut_count)}, int(strand));
  const bool changed = pieces != m_pieces;
  if (changed) {
    m_buffer.coarser.clear();
    lay_out(std::move(pieces));
    place(sim::initial_state(*m_model));
    lay_pattern();
  }
  place(state);
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
  if (changed)
    m_mesh.replace(m_buffer.data());
  else
    m_mesh.move(m_buffer.positions, m_buffer.normals);
}

}  // namespace trocar::view

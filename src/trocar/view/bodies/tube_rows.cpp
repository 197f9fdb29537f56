// A strand's rows, from end to end of every piece, and the triangles between them.
#include <algorithm>
#include <cmath>

#include <trocar/view/bodies/fimbria.hpp>
#include <trocar/view/bodies/tube_drawing.hpp>

namespace trocar::view {

using interactions::Clip;

namespace {

constexpr double kTubeStep = 0.0012;  // [m] between rings
constexpr double kAlongTurn = 7;      // rings to a turn of a ridge that winds around it
constexpr double kFineStep = 0.0004;  // [m] near a clip
constexpr double kNearClip = 0.004;   // [m]
constexpr double kNearCut = 0.003;    // [m] blood on it has a ragged border
constexpr double kSlant = 0.85;       // scissors cut askew: how far a stump's near side lies back, in radii
constexpr double kSealedSlant = 0.3;  // ... that of one that a clip holds flat
constexpr double kSlanted = 1.8;      // ... and how far along it, in radii
constexpr double kTornShare = 0.10, kTornFrom = 0.0012;  // share of the radius and [m]: how ragged its edge is
constexpr double kTubeBend = 0.01;  // [m] radius with which tubes curve, for rings that are left out

}  // namespace

std::vector<double> TubeDrawing::stations(const Layout& layout, const StrandPiece& piece) const {
  std::vector<double> at;
  const double step = m_relief->spiral > 0 ? std::min(kTubeStep, m_relief->spiral_size / kAlongTurn) : kTubeStep;
  const int steps = std::max(2, int(std::ceil((piece.to - piece.from) / step)));
  for (int i = 0; i <= steps; ++i) at.push_back(piece.from + (piece.to - piece.from) * i / steps);
  const auto finely = [&](double s) {
    for (double d = -kNearClip; d <= kNearClip; d += kFineStep)
      if (s + d > piece.from + 1e-5 && s + d < piece.to - 1e-5) at.push_back(s + d);
  };
  for (const Clip& clip : layout.clips) finely(clip.s);
  for (const double loop : layout.loops) finely(loop);
  for (double d = kFineStep; d < kNearCut; d += kFineStep) {
    if (piece.cut_start && piece.from + d < piece.to) at.push_back(piece.from + d);
    if (piece.cut_end && piece.to - d > piece.from) at.push_back(piece.to - d);
  }
  std::sort(at.begin(), at.end());
  at.erase(std::unique(at.begin(), at.end(), [](double a, double b) { return b - a < 1e-5; }), at.end());
  at.back() = piece.to;
  return at;
}

void TubeDrawing::add_raw_face(int piece, bool at_start) {
  const StrandPiece& p = m_layout.pieces[std::size_t(piece)];
  const double s = at_start ? p.from : p.to, sign = at_start ? -1 : 1, r = radius_at(s) * contracted(p, s);
  const double open = m_strand->inner.empty() ? 0 : m_strand->inner[std::size_t(at_start ? p.first : p.last)];
  const double lumen = std::clamp(open, 0.07 * r, 0.12 * r);
  // The serosa has drawn back, a thin film of blood on its torn edge; the muscle has contracted within it into a pale
  // ring, and the lining pouts over both in wet, pink lobes around what is left of the lumen: a slit with a clot in it.
  const Paint rim{190, 60, 30, 0}, muscle{195, 19, 34, 40}, mucosa{190, 42, 0, 150}, lining{150, 84, 0, 200};
  const Paint slit{100, 150, 0, 220}, clot{60, 215, 0, 255};
  std::vector<TubeRow> rows;
  const auto row = [&](double along, double radius, double scallop, Paint paint) {
    const double turn = 0.09 * double(rows.size());
    rows.push_back({piece, s, sign * along, radius, scallop, 0, false, paint, sign * kSlant, turn});
  };
  row(0, r, kTornShare, rim);
  row(0.09 * r, 0.97 * r, 0.18, muscle);
  row(0.17 * r, 0.90 * r, 0.20, muscle);
  row(0.20 * r, 0.86 * r, 0.20, mucosa);
  row(0.34 * r, 0.82 * r, 0.22, mucosa);
  row(0.50 * r, 0.66 * r, 0.30, mucosa);
  row(0.52 * r, 0.48 * r, 0.36, mucosa);
  row(0.40 * r, 0.34 * r, 0.36, lining);
  row(0.28 * r, 1.7 * lumen, 0.50, slit);
  row(0.20 * r, 0.8 * lumen, 0.50, clot);
  row(0.16 * r, 0, 0, clot);
  rows.front().crease = !at_start;
  if (at_start) std::reverse(rows.begin(), rows.end());
  m_rows.insert(m_rows.end(), rows.begin(), rows.end());
}

/// Is this cut end closed by a clip beside it? A uterine tube's muscle stands open all the same.
bool TubeDrawing::sealed(const StrandPiece& piece, bool at_start) const {
  if (m_strand->fimbriated || !(at_start ? piece.cut_start : piece.cut_end)) return false;
  const double end = at_start ? piece.from : piece.to;
  return std::any_of(m_layout.clips.begin(), m_layout.clips.end(), [&](const Clip& clip) {
    return clip.s >= piece.from && clip.s <= piece.to && closes_end(clip, end);
  });
}

/// Its wall has rolled in over what was the lumen: pleats that run together to a slit, as pale as the wall, stained by
/// what the tube carried; a thin line of blood on its edge.
void TubeDrawing::add_sealed_face(int piece, bool at_start) {
  const StrandPiece& p = m_layout.pieces[std::size_t(piece)];
  const double s = at_start ? p.from : p.to, sign = at_start ? -1 : 1, r = radius_at(s) * contracted(p, s);
  const Paint edge{200, 44, 0, 60}, wall{225, 10, 20, 90}, lining{185, 16, 0, 190}, slit{95, 60, 0, 230};
  std::vector<TubeRow> rows;
  const auto row = [&](double along, double radius, double pleats, Paint paint) {
    rows.push_back({piece, s, sign * along * r, radius * r, pleats, 0, false, paint, sign * kSealedSlant, 0});
  };
  row(0, 1, kTornShare, edge);
  row(0.16, 0.95, 0.12, edge);
  row(0.34, 0.80, 0.18, wall);
  row(0.42, 0.62, 0.26, wall);
  row(0.38, 0.44, 0.34, lining);
  row(0.24, 0.26, 0.42, lining);
  row(0.08, 0.12, 0.42, slit);
  row(0.02, 0, 0, slit);
  rows.front().crease = !at_start;
  if (at_start) std::reverse(rows.begin(), rows.end());
  m_rows.insert(m_rows.end(), rows.begin(), rows.end());
}

void TubeDrawing::add_start(int piece) {
  const StrandPiece& p = m_layout.pieces[std::size_t(piece)];
  if (sealed(p, true)) return add_sealed_face(piece, true);
  if (p.cut_start) return add_raw_face(piece, true);
  const double r = radius_at(p.from);
  if (m_start_root.there) return add_root(piece, true);
  m_rows.push_back({piece, p.from, -r, 0, 0, 0, false, {}});
  for (const double a : {0.3, 0.7, 1.1})
    m_rows.push_back({piece, p.from, -r * std::cos(a), r * std::sin(a), 0, 0, false, {}});
}

void TubeDrawing::add_end(int piece) {
  const StrandPiece& p = m_layout.pieces[std::size_t(piece)];
  if (sealed(p, false)) return add_sealed_face(piece, false);
  if (p.cut_end) return add_raw_face(piece, false);
  const double r = radius_at(p.to);
  if (m_strand->fimbriated) return;  // goes over into the fimbriae
  if (m_end_root.there) return add_root(piece, false);
  for (const double a : {1.1, 0.7, 0.3})
    m_rows.push_back({piece, p.to, r * std::cos(a), r * std::sin(a), 0, 0, false, {}});
  m_rows.push_back({piece, p.to, r, 0, 0, 0, false, {}});
}

void TubeDrawing::add_piece(const Layout& layout, int piece) {
  const StrandPiece& p = layout.pieces[std::size_t(piece)];
  add_start(piece);
  bool first = true;
  for (const double s : stations(layout, p)) {
    const double r = radius_at(s) * contracted(p, s);
    double slant = 0;
    if (p.cut_start) slant -= (sealed(p, true) ? kSealedSlant : kSlant) * smooth(kSlanted * r, 0, s - p.from);
    if (p.cut_end) slant += (sealed(p, false) ? kSealedSlant : kSlant) * smooth(kSlanted * r, 0, p.to - s);
    const double torn =
        std::max(p.cut_start ? smooth(kTornFrom, 0, s - p.from) : 0, p.cut_end ? smooth(kTornFrom, 0, p.to - s) : 0);
    m_rows.push_back({piece, s, 0, r, kTornShare * torn, 0, first && p.cut_start, {}, slant});
    first = false;
  }
  add_end(piece);
}

std::vector<Vec3f> TubeDrawing::band(double from, double to, int rings, float lift) const {
  const auto plain = [](const TubeRow& r) { return r.radius > 0 && r.along == 0 && r.out == 0; };
  std::vector<Vec3f> out;
  auto piece = m_rows.front().piece;  // of the first ring: a band that reaches over a cut is gone
  for (int r = 0; r < rings; ++r) {
    const double s = from + (to - from) * r / std::max(1, rings - 1);
    std::size_t i = 1;
    while (i < m_rows.size() && !(m_rows[i].piece == m_rows[i - 1].piece && plain(m_rows[i - 1]) && plain(m_rows[i]) &&
                                  m_rows[i - 1].s <= s && s <= m_rows[i].s && m_rows[i].s > m_rows[i - 1].s))
      ++i;
    if (i == m_rows.size()) return {};
    if (r == 0) piece = m_rows[i].piece;
    if (m_rows[i].piece != piece) return {};
    const auto w = float((s - m_rows[i - 1].s) / (m_rows[i].s - m_rows[i - 1].s));
    const std::size_t first = out.size();
    Vec3f middle{};
    for (int k = 0; k < m_sides; ++k) {
      const Vec3f a = m_buffer.positions[m_first[i - 1] + std::uint32_t(k)];
      const Vec3f b = m_buffer.positions[m_first[i] + std::uint32_t(k)];
      out.push_back((1 - w) * a + w * b);
      middle += out.back() / float(m_sides);
    }
    for (std::size_t k = first; k < out.size(); ++k) out[k] += lift * normalised(out[k] - middle);
  }
  return out;
}

void TubeDrawing::connect() {
  m_buffer = {};
  m_first.clear();
  std::vector<std::size_t> all;
  for (const TubeRow& row : m_rows) {
    all.push_back(all.size());
    m_first.push_back(m_buffer.size());
    for (int k = 0; k < (row.radius == 0 ? 1 : m_sides); ++k) m_buffer.add({});
  }
  join(all, 1, m_buffer);
  const std::uint32_t fingers = m_buffer.size();
  if (m_strand->fimbriated) {
    join_fimbriae(fingers, 1, m_buffer);
    append(m_buffer, m_fimbriae, Mat3f::identity(), {});
  }
  connect_coarsely();
  for (std::size_t k = 0; k < m_fimbriae.coarser.size(); ++k)
    for (const std::uint32_t v : m_fimbriae.coarser[k]) m_buffer.coarser[k].push_back(fingers + v);
}

/// Between every `stride`-th side of the last row and the fimbriae's first ring, which has more vertices.
void TubeDrawing::join_fimbriae(std::uint32_t fingers, std::uint32_t stride, MeshBuffer& into) const {
  const auto sides = std::uint32_t(m_sides), fine = std::uint32_t(kRimColumns) / sides * stride;
  static_assert(kRimColumns % 16 == 0 && kRimColumns % 12 == 0);
  const auto ring = [&](std::uint32_t k) { return fingers + k % std::uint32_t(kRimColumns); };
  for (std::uint32_t i = 0; i < sides; i += stride) {
    const std::uint32_t a = m_first.back() + i, b = m_first.back() + (i + stride) % sides;
    const std::uint32_t from = i / stride * fine, half = fine / 2;
    for (std::uint32_t k = 0; k < fine; ++k) into.triangle(k < half ? a : b, ring(from + k + 1), ring(from + k));
    into.triangle(a, b, ring(from + half));
  }
}

/// Triangles between these rows, of every `stride`-th side.
void TubeDrawing::join(const std::vector<std::size_t>& rows, std::uint32_t stride, MeshBuffer& into) const {
  const auto sides = std::uint32_t(m_sides);
  for (std::size_t n = 1; n < rows.size(); ++n) {
    const TubeRow &low = m_rows[rows[n - 1]], &high = m_rows[rows[n]];
    if (high.piece != low.piece || high.crease) continue;
    const std::uint32_t a = m_first[rows[n - 1]], b = m_first[rows[n]];
    for (std::uint32_t i = 0; i < sides; i += stride) {
      const std::uint32_t j = (i + stride) % sides;
      if (high.radius == 0)
        into.triangle(a + i, a + j, b);
      else if (low.radius == 0)
        into.triangle(b + j, b + i, a);
      else
        into.quad(a + i, a + j, b + j, b + i);
    }
  }
}

/// Plain rows at least so far apart [m], and all that are not plain.
std::vector<std::size_t> TubeDrawing::rows_apart(double distance) const {
  const auto plain = [](const TubeRow& r) { return r.radius > 0 && r.along == 0 && r.out == 0 && !r.crease; };
  const auto clipped = [this](double s) {
    const auto near = [s](double at) { return std::fabs(at - s) < kNearClip; };
    return std::any_of(m_layout.clips.begin(), m_layout.clips.end(),
                       [&near](const Clip& clip) { return near(clip.s); }) ||
           std::any_of(m_layout.loops.begin(), m_layout.loops.end(), near);
  };
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < m_rows.size(); ++i) {
    const TubeRow& row = m_rows[i];
    const bool inside = i > 0 && i + 1 < m_rows.size() && plain(row) && plain(m_rows[i - 1]) && plain(m_rows[i + 1]) &&
                        m_rows[i - 1].piece == row.piece && m_rows[i + 1].piece == row.piece;
    const double least = clipped(row.s) ? 0.3 * distance : distance;
    if (!inside || row.s - m_rows[kept.back()].s > least - 0.5 * kFineStep) kept.push_back(i);
  }
  return kept;
}

void TubeDrawing::connect_coarsely() {
  const double thickest = *std::max_element(m_strand->outer.begin(), m_strand->outer.end());
  for (const double error : m_errors) {
    MeshBuffer part;
    const std::uint32_t stride = side_stride(error, thickest, std::uint32_t(m_sides));
    join(rows_apart(ring_distance(error, kTubeBend)), stride, part);
    if (m_strand->fimbriated) join_fimbriae(m_buffer.size() - m_fimbriae.size(), stride, part);
    m_buffer.coarser.push_back(std::move(part.indices));
  }
}

}  // namespace trocar::view

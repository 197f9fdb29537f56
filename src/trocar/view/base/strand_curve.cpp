#include <algorithm>

#include <trocar/view/base/strand_curve.hpp>

namespace trocar::view {

using interactions::Cut;
using interactions::StrandBody;
using interactions::StrandPlace;

namespace {

/// Where element `e` was cut: at the last recorded cut through it, else in its middle.
double cut_arc(const StrandBody& body, int e, std::span<const Cut> cuts, int strand) {
  const double from = body.arc[std::size_t(e)], to = body.arc[std::size_t(e) + 1];
  double s = 0.5 * (from + to);
  for (const Cut& cut : cuts)
    if (cut.strand == strand && cut.s >= from && cut.s <= to) s = cut.s;
  const double rim = 0.05 * (to - from);
  return std::clamp(s, from + rim, to - rim);
}

}  // namespace

std::vector<StrandPiece> pieces_of(const StrandBody& body, std::span<const std::uint8_t> alive,
                                   std::span<const Cut> cuts, int strand) {
  std::vector<StrandPiece> pieces;
  StrandPiece piece{0, 0, 0, 0, false, false};
  for (int e = 0; e + 1 < body.nodes(); ++e) {
    if (!alive[std::size_t(e)]) {
      const double s = cut_arc(body, e, cuts, strand);
      piece.last = e;
      piece.to = s;
      piece.cut_end = true;
      pieces.push_back(piece);
      piece = {e + 1, e + 1, s, s, true, false};
    }
  }
  piece.last = body.nodes() - 1;
  piece.to = body.length();
  pieces.push_back(piece);
  return pieces;
}

StrandCurve::StrandCurve(const StrandBody& body, const tissue::StrandState& state, std::span<const StrandPiece> pieces)
    : m_body(&body), m_state(&state), m_pieces(pieces), m_frames(std::size_t(body.nodes() - 1)) {
  interactions::frames_of(body, state, m_frames.data());
}

Vec3d StrandCurve::slope(const StrandPiece& piece, int node) const {
  if (piece.first == piece.last) return m_frames[std::size_t(std::min(node, m_body->nodes() - 2))].tangent;
  const std::size_t a = std::size_t(std::max(node - 1, piece.first)), b = std::size_t(std::min(node + 1, piece.last));
  return (m_state->x[b] - m_state->x[a]) / (m_body->arc[b] - m_body->arc[a]);
}

Vec3d StrandCurve::normal_at(const StrandPiece& piece, StrandPlace place) const {
  const int last = m_body->nodes() - 2;
  const int low = std::clamp(place.w < 0.5 ? place.element - 1 : place.element, std::min(piece.first, last),
                             std::min(std::max(piece.last - 1, piece.first), last));
  const int high = std::clamp(low + 1, low, std::min(std::max(piece.last - 1, low), last));
  const double w = place.w < 0.5 ? place.w + 0.5 : place.w - 0.5;
  return (1 - w) * m_frames[std::size_t(low)].normal + w * m_frames[std::size_t(high)].normal;
}

CurveFrame StrandCurve::at(int index, double s) const {
  const StrandPiece& piece = m_pieces[std::size_t(index)];
  const double low = m_body->arc[std::size_t(piece.first)], high = m_body->arc[std::size_t(piece.last)];
  CurveFrame f;
  StrandPlace place = place_at(*m_body, s);
  if (s <= low || s >= high || piece.first == piece.last) {
    const bool before = s <= low;
    const int node = before ? piece.first : piece.last;
    const Vec3d along = slope(piece, node);
    f.tangent = normalised(along, m_frames[std::size_t(std::min(node, m_body->nodes() - 2))].tangent);
    f.point = m_state->x[std::size_t(node)] + (s - m_body->arc[std::size_t(node)]) * f.tangent;
    place = {std::min(node, m_body->nodes() - 2), node == m_body->nodes() - 1 ? 1.0 : 0.0};
  } else {
    const std::size_t e = std::size_t(place.element);
    const double h = m_body->arc[e + 1] - m_body->arc[e], t = place.w, u = 1 - t;
    const Vec3d a = m_state->x[e], b = m_state->x[e + 1];
    const Vec3d da = h * slope(piece, int(e)), db = h * slope(piece, int(e) + 1);
    f.point = (u * u * (1 + 2 * t)) * a + (t * t * (3 - 2 * t)) * b + (u * u * t) * da - (t * t * u) * db;
    const Vec3d along = (6 * t * u) * (b - a) + (u * (1 - 3 * t)) * da + (t * (3 * t - 2)) * db;
    f.tangent = normalised(along, m_frames[e].tangent);
  }
  const Vec3d n = normal_at(piece, place);
  f.normal = normalised(n - dot(n, f.tangent) * f.tangent, any_perpendicular(f.tangent));
  f.binormal = cross(f.tangent, f.normal);
  return f;
}

}  // namespace trocar::view

#include <algorithm>
#include <stdexcept>

#include <trocar/geometry/nurbs/curve_length.hpp>
#include <trocar/numerics/symmetric3.hpp>
#include <trocar/scene/description/fibres.hpp>

namespace trocar::scene {
namespace {

/// Of the pieces on both sides of a point, or of the only one.
Vec3d direction_at_point(const Stroke& stroke, std::size_t i) {
  const Vec3d& before = stroke[i == 0 ? 0 : i - 1];
  const Vec3d& after = stroke[std::min(i + 1, stroke.size() - 1)];
  const Vec3d back = stroke[i] - before, on = after - stroke[i];
  const double b = length(back), o = length(on);
  const Vec3d sum = (b > 0 ? back / b : Vec3d{}) + (o > 0 ? on / o : Vec3d{});
  return length(sum) > 1e-6 ? normalised(sum) : normalised(o > 0 ? on : back);
}

struct NearestPiece {
  std::size_t first = 0;  ///< of its two points
  double share = 0;       ///< of the way to the second
  double distance2 = 1e30;
};

NearestPiece nearest_piece(const Stroke& stroke, Vec3d place) {
  NearestPiece found;
  for (std::size_t i = 0; i + 1 < stroke.size(); ++i) {
    const Vec3d piece = stroke[i + 1] - stroke[i];
    const double share = std::clamp(dot(place - stroke[i], piece) / dot(piece, piece), 0.0, 1.0);
    const Vec3d off = place - (stroke[i] + share * piece);
    if (dot(off, off) < found.distance2) found = {i, share, dot(off, off)};
  }
  return found;
}

constexpr double kTouches2 = 1e-12;  // [m^2]: nearer than a thousandth of a millimetre is on the stroke

}  // namespace

Vec3d fibre_at(std::span<const Stroke> strokes, Vec3d place) noexcept {
  Mat3d sum;
  for (const Stroke& stroke : strokes) {
    const NearestPiece near = nearest_piece(stroke, place);
    const Vec3d a = direction_at_point(stroke, near.first), b = direction_at_point(stroke, near.first + 1);
    Vec3d t = (1 - near.share) * a + near.share * b;
    if (!(length(t) > 1e-6)) t = a;
    t = normalised(t);
    sum = sum + (1 / std::max(near.distance2, kTouches2)) * outer(t, t);
  }
  return numerics::principal(sum).axis[0];
}

Stroke middle_line(const Solid& solid) {
  Stroke line;
  if (solid.shape.tube) {
    constexpr int kPerPoint = 8;
    const geometry::nurbs::Curve curve = line_of(*solid.shape.tube);
    const int samples = std::min(kPerPoint * int(solid.shape.tube->line.size()), int(kMostStrokePoints));
    for (const double u : geometry::nurbs::parameters_by_length(curve, samples))
      line.push_back(geometry::nurbs::point(curve, u));
  }
  for (const Section& s : solid.sections) line.push_back(s.centre);
  if (line.size() < 2) throw std::invalid_argument("a body with a middle line, sections or a tube, expected");
  return line;
}

std::vector<Vec3d> fibres_in(const Solid& solid, std::span<const Vec3d> places) {
  std::vector<Stroke> strokes = solid.fibre_strokes;
  if (solid.fibres_along) strokes = {middle_line(solid)};
  std::vector<Vec3d> out;
  if (strokes.empty()) return out;
  out.reserve(places.size());
  for (const Vec3d& p : places) out.push_back(fibre_at(strokes, p));
  return out;
}

}  // namespace trocar::scene

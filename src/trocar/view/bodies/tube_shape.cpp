// How wide a strand is drawn, and which way it goes: the simulated line and radius, made uneven.
#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/view/bodies/fimbria.hpp>
#include <trocar/view/bodies/tube_drawing.hpp>

namespace trocar::view {
namespace {

constexpr double kRootFlare = 0.12;    // how much wider a strand is where it grows out of an organ
constexpr double kThinsInWall = 0.6;   // share of the radius that one loses before a wall ...
constexpr double kThinsFrom = 0.8;     // ... from here on along it
constexpr double kContracts = 0.0022;  // [m] of a cut end
constexpr double kIsthmus = 0.027;     // [m] of a uterine tube that is narrow and straight
constexpr double kCoil = 0.0006;       // [m] its drawn line winds about the simulated one

/// A smooth number in -1..1 along `x` whose swings differ in height and length: no even chain.
double tube_swing(double x, int seed) {
  const double cell = std::floor(x), t = x - cell;
  const auto at = [&](double c) { return 2 * varied(int(c), seed) - 1; };
  return at(cell) + (at(cell + 1) - at(cell)) * (t * t * (3 - 2 * t));
}

}  // namespace

double TubeDrawing::radius_at(double s) const {
  const interactions::StrandPlace at = place_at(*m_body, s);
  const std::size_t e = std::size_t(at.element), n = m_strand->outer.size();
  const std::vector<double>& r = m_strand->outer;
  const double a = r[e > 0 ? e - 1 : 0], b = r[e], c = r[e + 1], d = r[std::min(e + 2, n - 1)], w = at.w;
  // Uniform cubic B-spline: rounds the corners of the stations.
  const double u = 1 - w;
  double radius =
      (u * u * u * a + (3 * w * w * w - 6 * w * w + 4) * b + (3 * u * u * u - 6 * u * u + 4) * c + w * w * w * d) / 6;
  if (m_strand->fimbriated) radius *= bell_flare(m_body->length() - s) * bore(s);
  if (hosted(0)) radius *= 1 + kRootFlare * std::exp(-s / (0.9 * r.front()));
  if (hosted(m_body->nodes() - 1)) radius *= 1 + kRootFlare * std::exp(-(m_body->length() - s) / (0.9 * r.back()));
  if (m_strand->end.kind == sim::StrandEndModel::fixed)  // it goes into a wall, below what covers it there
    radius *= 1 - kThinsInWall * smooth(kThinsFrom * m_body->length(), m_body->length(), s);
  return radius;
}

/// How much of a uterine tube's windings a place has: none in the isthmus and where it opens.
double TubeDrawing::winding(double s) const {
  if (!m_strand->fimbriated) return 0;
  const double length = m_body->length();
  return smooth(kIsthmus, kIsthmus + 0.014, s) * smooth(length, length - 0.012, s);
}

/// Its bore is uneven: wide places and waists that are drawn, not simulated.
double TubeDrawing::bore(double s) const {
  const int seed = 300 + 7 * m_index;
  const double ampulla = 0.13 * tube_swing(s / 0.0117, seed) + 0.05 * tube_swing(s / 0.0049, seed + 1);
  return 1 + winding(s) * ampulla + 0.04 * tube_swing(s / 0.0041, seed + 2);
}

/// And so is its way: it coils gently about the simulated line, one tube in long bends, the other in short ones.
Vec3d TubeDrawing::coiled(double s, const CurveFrame& f) const {
  const double own = varied(m_index, 91), seed = 2.3 * m_index;
  const double k = 2 * portable::pi * s * (0.7 + 0.7 * own), amount = kCoil * (1.25 - 0.4 * own) * winding(s);
  if (amount <= 0) return {};
  const double a = std::sin(k / 0.0248 + seed) + 0.2 * std::sin(k / 0.0137 + 2 * seed),
               b = std::cos(k / 0.0291 + 1.4 * seed) + 0.2 * std::sin(k / 0.0153 + seed);
  return amount * (a * f.normal + b * f.binormal);
}

double TubeDrawing::outline(double s, double angle) const {
  const double k = 2 * portable::pi * s, seed = 1.7 * m_index;
  const int own = 500 + 7 * m_index;
  return 1 + 0.045 * tube_swing(s / 0.0063 + 0.5 * std::sin(angle + seed), own) +
         0.03 * std::sin(2 * angle + 4 * tube_swing(s / 0.019, own + 1) + seed) +
         0.018 * std::sin(3 * angle - k / 0.0061 + 2 * seed) + spiral(s, angle);
}

/// Share of the radius by which a ridge that winds around it stands out. Uneven: folds are no screw thread.
double TubeDrawing::spiral(double s, double angle) const {
  const Relief& relief = *m_relief;
  if (relief.spiral <= 0) return 0;
  const double swing = tube_swing(s / 0.0053, 700 + 7 * m_index);
  const double turn = 2 * portable::pi * s / relief.spiral_size + 0.6 * swing - angle;
  const double ridge = 0.5 + 0.5 * std::sin(turn);
  return (1 + 0.3 * swing) * relief.spiral * (ridge * ridge - 0.4) / m_strand->outer.front();
}

bool TubeDrawing::hosted(int node) const {
  const sim::StrandEndModel& end = node == 0 ? m_strand->start : m_strand->end;
  return end.kind == sim::StrandEndModel::hosted;
}

/// Its muscle narrows a cut end.
double TubeDrawing::contracted(const StrandPiece& piece, double s) const {
  double amount = 0;
  if (piece.cut_start) amount = smooth(kContracts, 0, s - piece.from);
  if (piece.cut_end) amount = std::max(amount, smooth(kContracts, 0, piece.to - s));
  return 1 - 0.12 * amount;
}

}  // namespace trocar::view

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/random.hpp>
#include <trocar/core/text.hpp>
#include <trocar/kinematics/loops/mobility.hpp>
#include <trocar/numerics/singular_values.hpp>

namespace trocar::kinematics {
namespace {

constexpr double kNone = 1e-7;  // singular values below are none
constexpr double kStride = 0.2;

}  // namespace

Mobility mobility(const Mechanism& m, std::span<double> u, int poses, unsigned seed) {
  Mobility out;
  out.coordinates = m.u_count();
  out.conditions = m.rows;
  out.counted = out.coordinates - out.conditions;
  out.mobility = out.coordinates;
  out.smallest = 1e300;
  LoopWork w(m);
  hold(w, {});
  core::Random random(seed);
  std::vector<double> at(u.begin(), u.end()), matrix, values(std::size_t(m.u_count())), z(std::size_t(m.u_count()));
  std::vector<int> ranks;
  for (int pose = 0, tries = 0; pose < poses && tries < 4 * poses; ++tries) {
    const LoopReport report = close(m, at, w);
    if (!report.closed()) {
      if (out.poses == 0) break;
      std::copy(u.begin(), u.end(), at.begin());
      close(m, at, w);
    } else {
      if (out.poses++ == 0) std::copy(at.begin(), at.end(), u.begin());
      ++pose;
      matrix = w.slope;
      std::fill(values.begin(), values.end(), 0.0);
      if (m.rows > 0) numerics::singular_values(m.rows, m.u_count(), matrix.data(), values.data());
      int rank = 0;
      for (const double s : values) {
        rank += s > kNone;
        if (s <= kNone && std::min(m.rows, m.u_count()) > 0) out.largest_none = std::max(out.largest_none, s);
      }
      ranks.push_back(rank);
      if (rank > out.rank) {
        out.rank = rank;
        out.smallest = 1e300;
      }
      if (rank == out.rank && rank > 0) out.smallest = std::min(out.smallest, values[std::size_t(rank) - 1]);
    }
    const int freedoms = m.u_count() - (m.rows > 0 ? w.qr.rank() : 0);
    for (int k = 0; k < freedoms; ++k) {
      const double along = random.uniform(-kStride, kStride);
      if (m.rows > 0)
        w.qr.null_vector(k, z.data());
      else
        for (std::size_t i = 0; i < z.size(); ++i) z[i] = int(i) == k;
      for (std::size_t i = 0; i < z.size(); ++i) at[i] += along * z[i] * m.scale(int(i));
    }
  }
  for (const int rank : ranks) out.singular_poses += rank < out.rank;
  out.mobility = out.coordinates - out.rank;
  if (out.rank == 0) out.smallest = 0;
  return out;
}

std::string words(const Mobility& m) {
  if (m.poses == 0) return "no closed pose was found, so the mobility is not known";
  std::string text = tr("mobility {} ({} coordinates, rank {}, {} poses)", m.mobility, m.coordinates, m.rank, m.poses);
  if (m.over_constrained())
    text += tr("; over-constrained but consistent: {} of {} conditions follow from the others, where counting says {}",
               m.conditions - m.rank, m.conditions, m.counted);
  if (m.singular_poses > 0) text += tr("; {} of the poses singular", m.singular_poses);
  return text;
}

}  // namespace trocar::kinematics

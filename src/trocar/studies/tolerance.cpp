#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <trocar/core/random.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/studies/handles.hpp>
#include <trocar/studies/tolerance.hpp>

namespace trocar::studies {

using namespace kinematics;

namespace {

Frame seen_from(const Mechanism& m, const Measured& what, const Pose& pose) noexcept {
  const Frame f = place(m.frames[std::size_t(what.frame)], pose);
  return what.from < 0 ? f : inverse(place(m.frames[std::size_t(what.from)], pose)) * f;
}

/// Which parameters places depend on: those of any dimension that is not a shape's.
std::vector<char> placing_parameters(const Mechanism& m) {
  std::vector<char> of_shape(m.dimensions.size(), 0), placing(m.parameters.size(), 0);
  for (const BodyShape& s : m.shapes)
    std::fill_n(of_shape.begin() + s.dimensions, s.kind == ShapeKind::box ? 9 : 7, char(1));
  for (std::size_t d = 0; d < m.dimensions.size(); ++d)
    for (int t = m.term_start[d]; t < m.term_start[d + 1]; ++t)
      if (!of_shape[d] && m.terms[std::size_t(t)].factor != 0)
        placing[std::size_t(m.terms[std::size_t(t)].parameter)] = 1;
  return placing;
}

/// Errors of one sample: numbers that its own number begins.
class Errors {
 public:
  Errors(std::uint64_t seed, std::int64_t sample) noexcept
      : m_random(core::Random(core::Random(seed).next() ^ std::uint64_t(sample)).next()) {}
  double uniform() noexcept { return m_random.uniform(-1, 1); }
  /// [Box & Muller 1958]; the second of a pair is kept.
  double normal() noexcept {
    if (m_kept) {
      m_kept = false;
      return m_second;
    }
    const double radius = std::sqrt(-2 * portable::log(1 - m_random.uniform()));
    const double angle = portable::two_pi * m_random.uniform();
    m_second = radius * portable::sin(angle);
    m_kept = true;
    return radius * portable::cos(angle);
  }

 private:
  core::Random m_random;
  double m_second = 0;
  bool m_kept = false;
};

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double measure(const Mechanism& m, const Measured& what, const Pose& pose, const Frame& nominal) noexcept {
  if (what.kind == MeasuredKind::turn) return dot(turn_between(nominal.r, seen_from(m, what, pose).r), what.direction);
  Vec3d p = place(m.frames[std::size_t(what.frame)], pose).p;
  if (what.from >= 0) p = p - place(m.frames[std::size_t(what.from)], pose).p;
  return what.kind == MeasuredKind::along ? dot(p, what.direction) : length(p);
}

std::vector<Toleranced> everywhere(const Mechanism& m, double length, double angle) {
  const std::vector<char> placing = placing_parameters(m);
  std::vector<Toleranced> out;
  for (std::size_t i = 0; i < m.parameters.size(); ++i) {
    const Parameter& p = m.parameters[i];
    const double general = p.measure == Measure::length ? length : p.measure == Measure::angle ? angle : 0;
    const double by = general > 0 ? general : p.tolerance;
    if (placing[i] && by > 0) out.push_back({int(i), by});
  }
  return out;
}

/// What one thread works with.
struct ToleranceStudy::Lane {
  explicit Lane(const ToleranceStudy& s)
      : changed(s.m), work(s.m), values(s.m.parameter_values), u(s.m_start), response(s.m_start) {
    hold_for_study(s.m, work);
    options.rank = s.m_rank;
  }
  Mechanism changed;
  LoopWork work;
  LoopOptions options;
  std::vector<double> values, u, response;  ///< response: d u / d parameter, of slope_of
  LoopReport report;
};

ToleranceStudy::ToleranceStudy(const Mechanism& mechanism, std::span<const double> handles, const Measured& what,
                               const std::vector<Toleranced>& tolerances, Distribution distribution)
    : m(mechanism), m_handles(handles.begin(), handles.end()), m_what(what), m_distribution(distribution) {
  if (m_handles.size() != m.drives.size() || m_what.frame < 0 || m_what.frame >= int(m.frames.size()))
    throw std::invalid_argument("expected a handle for every drive and a frame of the mechanism");
  m.shapes.clear();  // no place depends on them
  m_start = m.start_u();
  LoopWork work(m);
  hold_for_study(m, work);
  LoopReport report = close(m, m_start, work);
  if (!report.closed()) throw std::invalid_argument("the start: " + words(m, report));
  const MoveReport moved = move_handles(m, m_handles, m_start, branch_at(m, m_start, work), work);
  if (!moved.arrived()) throw std::invalid_argument(words(m, moved));
  report = close(m, m_start, work);
  if (report.status != LoopStatus::closed || report.limit >= 0) throw std::invalid_argument(words(m, report));
  if (report.idle() > 0) throw std::invalid_argument("expected drives that hold every freedom; " + words(m, report));
  m_rank = report.rank;
  m_nominal = seen_from(m, m_what, work.pose);
  m_linear.nominal = measure(m, m_what, work.pose, m_nominal);
  differentiate(tolerances);
}

/// The quantity with the lane's parameters, closed from the lane's pose on.
double ToleranceStudy::value_with(Lane& lane) const noexcept {
  lane.changed.assign(lane.values);
  set_handles(lane.changed, m_handles, lane.u);
  lane.report = close(lane.changed, lane.u, lane.work, lane.options);
  if (lane.report.status != LoopStatus::closed) return kNone;
  return measure(lane.changed, m_what, lane.work.pose, m_nominal);
}

/// Central difference of closed poses [Tolerance].
double ToleranceStudy::slope_of(Lane& lane, const Toleranced& t, double& gap) const noexcept {
  double& p = lane.values[std::size_t(t.parameter)];
  const double here = p, step = 0.1 * t.plus_minus;
  double value[2];
  gap = 0;
  for (int k = 0; k < 2; ++k) {
    p = here + (k ? step : -step);
    std::copy(m_start.begin(), m_start.end(), lane.u.begin());
    value[k] = value_with(lane);
    for (std::size_t i = 0; i < lane.u.size(); ++i)
      lane.response[i] = k ? (lane.u[i] - lane.response[i]) / (2 * step) : lane.u[i];
    if (!lane.report.closed()) gap = std::max({gap, lane.report.metres, lane.report.radians});
  }
  p = here;
  gap *= t.plus_minus / step;
  return (value[1] - value[0]) / (2 * step);
}

void ToleranceStudy::differentiate(const std::vector<Toleranced>& tolerances) {
  Lane lane(*this);
  double squares = 0;
  for (const Toleranced& t : tolerances) {
    double gap = 0;
    const double slope = slope_of(lane, t, gap);
    if (!std::isfinite(slope)) {
      m_misfits.push_back({t.parameter, gap});
      continue;
    }
    m_varied.push_back(t);
    m_response.insert(m_response.end(), lane.response.begin(), lane.response.end());
    const Sensitivity s{t.parameter, t.plus_minus, slope};
    m_linear.ranked.push_back(s);
    m_linear.worst += std::fabs(s.effect());
    squares += s.effect() * s.effect();
  }
  m_linear.rss = std::sqrt(squares);
  m_linear.deviation = m_distribution == Distribution::normal ? m_linear.rss / 3 : std::sqrt(squares / 3);
  for (Sensitivity& s : m_linear.ranked) s.share = squares > 0 ? s.effect() * s.effect() / squares : 0;
  std::stable_sort(m_linear.ranked.begin(), m_linear.ranked.end(), [](const Sensitivity& a, const Sensitivity& b) {
    return std::fabs(a.effect()) > std::fabs(b.effect());
  });
}

void ToleranceStudy::sample(std::uint64_t seed, std::int64_t first, std::span<double> values,
                            core::ThreadPool* pool) const {
  constexpr std::int64_t kBlock = 512;  // samples that a thread takes at a time
  const auto count = std::int64_t(values.size());
  const std::int64_t blocks = (count + kBlock - 1) / kBlock;
  const auto threads = std::int64_t(pool ? pool->threads() : 1);
  const std::int64_t lanes = std::max<std::int64_t>(1, std::min(blocks, threads));
  std::vector<Lane> work(std::size_t(lanes), Lane(*this));
  auto along = [&](int k) noexcept {
    Lane& lane = work[std::size_t(k)];
    for (std::int64_t block = k; block < blocks; block += lanes)
      for (std::int64_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i) {
        Errors errors(seed, first + i);
        std::copy(m_start.begin(), m_start.end(), lane.u.begin());
        const double* response = m_response.data();
        for (const Toleranced& t : m_varied) {
          const double e = m_distribution == Distribution::normal ? errors.normal() / 3 : errors.uniform();
          lane.values[std::size_t(t.parameter)] = m.parameter_values[std::size_t(t.parameter)] + t.plus_minus * e;
          for (double& u : lane.u) u += *response++ * t.plus_minus * e;
        }
        values[std::size_t(i)] = value_with(lane);
      }
  };
  if (pool)
    core::run(*pool, int(lanes), along);
  else
    along(0);
}

}  // namespace trocar::studies

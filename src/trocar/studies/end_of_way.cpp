#include <algorithm>
#include <cmath>

#include <trocar/studies/end_of_way.hpp>
#include <trocar/studies/handles.hpp>

namespace trocar::studies {

using namespace kinematics;

namespace {

constexpr int kLooks = 16;  // over a parameter's bounds, before the nearest is refined
constexpr int kRefinements = 40;
constexpr double kGoldenShare = 0.6180339887498949;

/// A mechanism that is led along its only drive.
class Led {
 public:
  explicit Led(const Mechanism& mechanism) : m(mechanism), m_work(mechanism), m_u(mechanism.start_u()) {
    if (m.drives.size() != 1) return;
    hold_drives(m, m_work);
    m_stands = close(m, m_u, m_work).closed();
    if (m_stands) m_branch = branch_at(m, m_u, m_work);
  }

  /// Where it is with the drive's coordinate at a value; from the last place where it got to.
  std::optional<EndOfWay> at(double value, int follow) {
    if (!m_stands) return {};
    std::vector<double> u = m_u;
    if (!move(m, u, {{m.drives[0].independent, value}}, m_branch, m_work).arrived()) return {};
    m_u = u;
    EndOfWay end;
    if (follow >= 0) end.followed = place(m.frames[std::size_t(follow)], m_work.pose).p;
    const int upper = m.frame("tip_upper"), lower = m.frame("tip_lower");
    if (upper >= 0 && lower >= 0)
      end.jaws =
          inverse(place(m.frames[std::size_t(lower)], m_work.pose)) * place(m.frames[std::size_t(upper)], m_work.pose);
    return end;
  }

 private:
  const Mechanism& m;
  LoopWork m_work;
  std::vector<double> m_u;
  Branch m_branch;
  bool m_stands = false;
};

}  // namespace

double EndOfWay::off(const EndOfWay& as_drawn, double size) const noexcept {
  double most = 0;
  if (followed && as_drawn.followed) most = length(*followed - *as_drawn.followed);
  if (jaws && as_drawn.jaws)
    most = std::max({most, length(jaws->p - as_drawn.jaws->p), size * length(turn_between(as_drawn.jaws->r, jaws->r))});
  return most;
}

std::optional<EndOfWay> end_of_way(const Mechanism& m, int follow) {
  if (m.drives.size() != 1) return {};
  return Led(m).at(m.drives[0].at_1, follow);
}

int end_parameter(const Mechanism& m) {
  if (m.drives.size() != 1) return -1;
  const auto end = std::size_t(m.drives[0].dimensions) + 1;
  const int first = m.term_start[end];
  if (m.term_start[end + 1] != first + 1 || m.base[end] != 0) return -1;
  const Mechanism::Term& only = m.terms[std::size_t(first)];
  const Parameter& p = m.parameters[std::size_t(only.parameter)];
  const auto uses = std::count_if(m.terms.begin(), m.terms.end(),
                                  [&only](const Mechanism::Term& t) { return t.parameter == only.parameter; });
  return only.factor == 1 && uses == 1 && only.parameter < m.named_parameters && p.low < p.high ? only.parameter : -1;
}

double fitted_end(const Mechanism& m, int parameter, int follow, const EndOfWay& as_drawn) {
  const Parameter& p = m.parameters[std::size_t(parameter)];
  Led led(m);
  double best = m.parameter_values[std::size_t(parameter)], least = 1e300;
  const auto look = [&](double value) {
    const std::optional<EndOfWay> end = led.at(value, follow);
    const double off = end ? end->off(as_drawn, m.length) : 1e300;
    if (off < least) least = off, best = value;
    return off;
  };
  for (int k = 0; k <= kLooks; ++k) look(p.low + (p.high - p.low) * k / kLooks);
  const double step = (p.high - p.low) / kLooks;
  double low = std::max(p.low, best - step), high = std::min(p.high, best + step);
  double left = high - kGoldenShare * (high - low), right = low + kGoldenShare * (high - low);
  double at_left = look(left), at_right = look(right);
  for (int k = 0; k < kRefinements; ++k) {
    if (at_left <= at_right) {
      high = right, right = left, at_right = at_left;
      left = high - kGoldenShare * (high - low);
      at_left = look(left);
    } else {
      low = left, left = right, at_left = at_right;
      right = low + kGoldenShare * (high - low);
      at_right = look(right);
    }
  }
  return best;
}

}  // namespace trocar::studies

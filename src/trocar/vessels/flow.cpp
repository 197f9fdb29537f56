// One tick of blood flow. The step reads like this:
//   what drives it | openings and clips, what feeds them | rows | cells | ends | sources | cells with sites |
//   eliminate | new pressures, flows, ends, books
#include <cmath>
#include <cstddef>

#include <trocar/numerics/portable.hpp>
#include <trocar/vessels/sites.hpp>

namespace trocar::vessels {
namespace {

constexpr double kUsualVolume = 5e-3;  // of blood in the patient that the loss response is for [m^3]
constexpr double kFastest = 0.04;      // (u / c)^2 up to which the flow carries waves along
constexpr double kSteepest = 0.3;      // what a taper may change the flow by in a tick, of the flow
constexpr double kMostCarried = 0.45;  // keeps the matrix dominant in long cells
constexpr double kSurprise = 0.1;      // of what a row takes up
constexpr int kAgain = 3;
constexpr double kRounding = 1e-13;    // of a conductance
constexpr double kHighPressure = 1e5;  // [Pa]

/// What the patient does during this tick.
struct Drive {
  double arterial = 0, venous = 0;  ///< at the moment that the tick's mean flows stand for [Pa]
  double beat = 0;                  ///< phase at that moment
  double share = 1;                 ///< of the mean pressure that loss has left
  double rate = 0;                  ///< [1/min]
};

/// A table of equal steps over one period, straight lines between.
double periodic(std::span<const double> wave, double phase) {
  const double x = (phase - std::floor(phase)) * double(wave.size());
  std::size_t i = std::size_t(x);
  if (i >= wave.size()) i = 0;
  const std::size_t j = i + 1 < wave.size() ? i + 1 : 0;
  return wave[i] + (x - double(i)) * (wave[j] - wave[i]);
}

LossResponse response_of(const FlowModel& m, const FlowState& s) {
  const double lost = double(s.bled - s.infused) * kPicolitre;
  return response_to(m.heart, lost * (kUsualVolume / m.blood.volume));
}

Drive drive(const FlowModel& m, const FlowState& s) {
  const LossResponse now = response_of(m, s);
  const double ahead = m.settings.implicitness * m.settings.tick / 60;
  Drive d;
  d.rate = m.heart.rate * now.rate;
  d.share = now.mean;
  d.beat = s.beat + ahead * d.rate;
  const double pulse = m.heart.systolic - m.heart.diastolic;
  const double mean = m.heart.diastolic + m.beat_mean * pulse;
  const double breath = portable::sin(2 * portable::pi * (s.breath + ahead * m.heart.breaths));
  d.arterial = now.mean *
               (mean + now.pulse * pulse * (periodic(m.beat, d.beat) - m.beat_mean) + m.heart.arterial_swing * breath);
  d.venous = m.heart.venous_swing * breath;
  return d;
}

/// dV/dp of a row.
double capacity(const FlowModel& m, std::size_t row, double p) {
  const double q = p > m.low[row] ? (p < m.high[row] ? p : m.high[row]) : m.low[row];
  return m.give[row] + 2 * m.give2[row] * q;
}

/// What a row holds beyond what it does at no pressure, if no pressure lies between `low` and `high`, else a constant
/// less: the integral of capacity().
double volume(const FlowModel& m, std::size_t row, double p) {
  const double q = p > m.low[row] ? (p < m.high[row] ? p : m.high[row]) : m.low[row];
  const double give = m.give[row], give2 = m.give2[row];
  return (give + give2 * q) * q + (give + 2 * give2 * q) * (p - q);
}

/// Volume that a row takes up when its pressure changes.
double taken_up(const FlowModel& m, std::size_t row, double p, double change) {
  const double to = p + change;
  if (p > m.low[row] && to > m.low[row] && p < m.high[row] && to < m.high[row])
    return (m.give[row] + 2 * m.give2[row] * (p + 0.5 * change)) * change;
  return volume(m, row, to) - volume(m, row, p);
}

/// What rows take up, as a straight line through the middle of the tick as the last change lets expect it.
void expect(const FlowModel& m, const FlowState& s, FlowWork& w) {
  for (std::size_t i = 0; i < m.give.size(); ++i) {
    w.ahead[i] = s.p[i] + 0.5 * s.dp[i];
    w.capacity[i] = capacity(m, i, w.ahead[i]);
    w.extra[i] = 0;
  }
}

/// Is what some row takes up far from what it was expected to?
bool surprised(const FlowModel& m, const FlowState& s, const FlowWork& w) {
  for (std::size_t i = 0; i < m.give.size(); ++i) {
    const double in = taken_up(m, i, s.p[i], w.x[i]), off = in - (w.capacity[i] * w.x[i] - w.extra[i]);
    if (off * off > kSurprise * kSurprise * in * in) return true;
  }
  return false;
}

/// Newton's method where walls or orifices went other ways than their straight lines: the lines through what was found.
/// Volumes are convex in pressure and the matrix dominant by columns, so it closes in from one side [Brugnano & Casulli
/// 2008 for such systems]. @return false: nothing is worth it
bool expect_again(const FlowModel& m, const FlowState& s, FlowWork& w) {
  bool again = surprised(m, s, w);
  for (int i = 0; i < w.chain_count; ++i) {
    const FlowCell& c = m.cells[w.chains[i].cell];
    const double theta = m.settings.implicitness;
    again |= guess_again(w.chains[i], s.p[c.a] + theta * w.x[c.a], s.p[c.b] + theta * w.x[c.b], w);
  }
  if (!again) return false;
  for (std::size_t i = 0; i < m.give.size(); ++i) {
    w.capacity[i] = capacity(m, i, s.p[i] + w.x[i]);
    w.extra[i] = w.capacity[i] * w.x[i] - taken_up(m, i, s.p[i], w.x[i]);
  }
  return true;
}

void assemble_rows(const FlowModel& m, const FlowState& s, FlowWork& w) {
  const double per_tick = 1 / m.settings.tick;
  for (std::size_t i = 0; i < m.give.size(); ++i) {
    w.diagonal[i] = w.capacity[i] * per_tick;
    w.x[i] = (s.owed[i] + w.extra[i]) * per_tick;
  }
  for (double& v : w.values) v = 0;
}

/// A cell in the middle of the tick.
struct CellNow {
  double xa, xb, xm;  ///< sqrt(A / A_ref) at its ends and in its middle
  double inverse;     ///< 1 / A [1/m^2]
  double flow;        ///< [m^3/s]
  CellTerms terms;
};

CellNow cell_now(const FlowCell& c, double pa, double pb, double q, double dq) {
  CellNow now;
  now.xa = widening(c.rest, c.give, pa), now.xb = widening(c.rest, c.give, pb);
  now.xm = 0.5 * (now.xa + now.xb);
  now.inverse = 1 / (c.area * now.xm * now.xm);
  now.flow = q + 0.5 * dq;
  const double loss = c.loss * (now.flow < 0 ? -now.flow : now.flow);
  now.terms.inertia = c.inertia * now.inverse;
  now.terms.resistance = (c.friction + loss) * now.inverse * now.inverse;
  return now;
}

/// Mean flow of the tick as flow0 + flow_a dp_a - flow_b dp_b, into the system. With Q_x = -A_t the momentum that the
/// flow carries, (Q^2 / A)_x = -2 u A_t - u^2 A_x: the first is taken with the pressures to come, so that waves run at
/// u + c however coarse the cells.
void assemble_cells(const FlowModel& m, const FlowState& s, int first, int last, FlowWork& w) {
  const double theta = m.settings.implicitness, rho = m.blood.density;
  const int* entry = m.plan.entry_of_link.data();
  for (int i = first; i < last; ++i) {
    const FlowCell& c = m.cells[i];
    const CellNow now = cell_now(c, w.ahead[c.a], w.ahead[c.b], s.q[i], s.dq[i]);
    const double u = now.flow * now.inverse;
    double carried = c.carried * now.xm * now.inverse * u;
    const double mach2 = carried * u * c.courant;
    const double soft = mach2 > kFastest ? kFastest / mach2 : 1;
    carried *= soft;
    carried = carried > kMostCarried ? kMostCarried : carried < -kMostCarried ? -kMostCarried : carried;
    const double wider = c.area_b * now.xb * now.xb - c.area_a * now.xa * now.xa;
    const double g = 1 / (now.terms.inertia + now.terms.resistance);
    const double steep = 2 * (u < 0 ? -u : u) * (wider < 0 ? -wider : wider) * now.inverse * c.courant;
    const double push = soft * rho * u * u * wider * now.inverse;
    const double pull = s.p[c.a] - s.p[c.b] + (steep > kSteepest ? push * (kSteepest / steep) : push);
    const double flow0 = g * (now.terms.inertia * s.q[i] + pull);
    const double flow_a = g * (theta + carried), flow_b = g * (theta - carried);
    w.flow0[i] = flow0, w.flow_a[i] = flow_a, w.flow_b[i] = flow_b;
    w.diagonal[c.a] += flow_a, w.diagonal[c.b] += flow_b;
    w.x[c.a] -= flow0, w.x[c.b] += flow0;
    w.values[entry[i]] -= flow_b, w.values[entry[i] ^ 1] -= flow_a;
  }
}

/// A cell with openings or clips: its ends feel what is left of it once its places are eliminated.
void assemble_chain(const FlowModel& m, const FlowState& s, FlowChain& chain, bool again, FlowWork& w) {
  const FlowCell& c = m.cells[chain.cell];
  const double theta = m.settings.implicitness;
  const CellNow now = cell_now(c, w.ahead[c.a], w.ahead[c.b], s.q[chain.cell], 0);
  const auto end = [&](int row) {
    return ChainEnd{s.p[row] + theta * w.x[row] / w.diagonal[row], w.diagonal[row] / theta};
  };
  reduce_chain(s, chain, now.terms, end(c.a), end(c.b), again, w);
  const FlowPoint& head = w.points[chain.first_point];
  const FlowPoint& before_end = w.points[chain.first_point + chain.points - 1];
  const FlowPoint& tail = w.points[chain.first_point + chain.points];
  const double in_b = head.g * head.from_b, on_a = tail.g * before_end.from_a;
  double in_a = head.g * (1 - head.from_a), on_b = tail.g * (1 - before_end.from_b);
  double in0 = head.s - head.g * head.fixed, on0 = tail.s + tail.g * before_end.fixed;
  // What is left of an end that leads nowhere is rounding, which must not become a flow.
  if (in_a < kRounding * head.g) in_a = in_b, in0 = 0;
  if (on_b < kRounding * tail.g) on_b = on_a, on0 = 0;
  const int entry = m.plan.entry_of_link[chain.cell];
  w.diagonal[c.a] += theta * in_a, w.diagonal[c.b] += theta * on_b;
  w.values[entry] -= theta * in_b, w.values[entry ^ 1] -= theta * on_a;
  w.x[c.a] -= in0 + in_a * s.p[c.a] - in_b * s.p[c.b];
  w.x[c.b] += on0 + on_a * s.p[c.a] - on_b * s.p[c.b];
}

/// Windkessel: the change of its compliance's pressure follows from that of the row, eliminated here.
double end_flow0(const FlowModel& m, const FlowEnd& e, double p, double inside) {
  if (e.inner == 0) return e.conductance * (p - e.pressure);
  const double share = m.settings.implicitness * e.near * e.inner;
  return e.near * (p - inside) * (1 - share) + share * e.far * (inside - e.pressure);
}

void assemble_ends(const FlowModel& m, const FlowState& s, FlowWork& w) {
  for (std::size_t i = 0; i < m.ends.size(); ++i) {
    const FlowEnd& e = m.ends[i];
    w.diagonal[e.row] += m.settings.implicitness * e.conductance;
    w.x[e.row] -= end_flow0(m, e, s.p[e.row], s.end_pressure[i]);
  }
}

double source_pressure(const FlowSource& source, const Drive& d) {
  if (source.kind == VesselSource::Kind::heart) return d.arterial;
  return source.venous ? source.pressure + d.venous : source.pressure * d.share;
}

void assemble_sources(const FlowModel& m, const FlowState& s, const Drive& d, FlowWork& w) {
  for (const FlowSource& source : m.sources) {
    if (source.kind == VesselSource::Kind::pump) {
      w.x[source.row] += periodic(source.wave, d.beat) * d.share;
      continue;
    }
    w.diagonal[source.row] += m.settings.implicitness * source.conductance;
    w.x[source.row] += source.conductance * (source_pressure(source, d) - s.p[source.row]);
  }
}

int first_beyond(std::span<const double> x, double limit) {
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!(x[i] > -limit && x[i] < limit)) return int(i);
  return -1;
}

void update_ends(const FlowModel& m, FlowState& s, const FlowWork& w) {
  for (std::size_t i = 0; i < m.ends.size(); ++i) {
    const FlowEnd& e = m.ends[i];
    if (e.inner == 0) continue;
    const double inside = s.end_pressure[i];
    const double in = e.near * (s.p[e.row] + m.settings.implicitness * w.x[e.row] - inside);
    s.end_pressure[i] = inside + e.inner * (in - e.far * (inside - e.pressure));
  }
}

void update_chains(const FlowModel& m, std::span<OpeningFlow> flows, FlowState& s, FlowWork& w) {
  const double theta = m.settings.implicitness;
  for (int i = 0; i < w.chain_count; ++i) {
    const FlowCell& c = m.cells[w.chains[i].cell];
    finish_chain(m, w.chains[i], s.p[c.a] + theta * w.x[c.a], s.p[c.b] + theta * w.x[c.b], flows, s, w);
  }
}

void update_cells(const FlowModel& m, int first, int last, FlowState& s, const FlowWork& w) {
  const double per_theta = 1 / m.settings.implicitness;
  for (int i = first; i < last; ++i) {
    const FlowCell& c = m.cells[i];
    const double mean = w.flow0[i] + w.flow_a[i] * w.x[c.a] - w.flow_b[i] * w.x[c.b];
    s.dq[i] = (mean - s.q[i]) * per_theta;
    s.q[i] += s.dq[i];
  }
}

/// Pressures, and the volume by which the straight lines missed the walls' law.
void update_rows(const FlowModel& m, FlowState& s, const FlowWork& w, FlowReport& report) {
  for (std::size_t i = 0; i < m.give.size(); ++i) {
    const double change = w.x[i];
    s.owed[i] = w.capacity[i] * change - w.extra[i] - taken_up(m, i, s.p[i], change);
    s.p[i] += change;
    s.dp[i] = change;
    if (s.p[i] > kHighPressure) report.flags |= FlowReport::kHighPressure;
  }
}

void update_patient(const FlowModel& m, const FlowInput& in, const Drive& d, FlowState& s) {
  s.beat += m.settings.tick / 60 * d.rate;
  s.beat -= std::floor(s.beat);
  s.breath += m.settings.tick / 60 * m.heart.breaths;
  s.breath -= std::floor(s.breath);
  if (!(in.infusion > 0 && in.infusion < 1)) return;
  s.infusion_remainder += in.infusion * m.settings.tick / kPicolitre;
  const std::int64_t whole = std::int64_t(s.infusion_remainder);
  s.infused += whole;
  s.infusion_remainder -= double(whole);
}

/// Calls body(first, last) for the runs of cells between those with sites.
template <class F>
void plain_cells(const FlowModel& m, const FlowWork& w, F&& body) {
  int first = 0;
  for (int i = 0; i < w.chain_count; ++i) {
    body(first, w.chains[i].cell);
    first = w.chains[i].cell + 1;
  }
  body(first, int(m.cells.size()));
}

/// The changes of pressure of this tick, in w.x. @return -1, or the first row that has none
int solve(const FlowModel& m, const FlowState& s, const Drive& d, bool again, FlowWork& w) {
  assemble_rows(m, s, w);
  plain_cells(m, w, [&](int first, int last) { assemble_cells(m, s, first, last, w); });
  assemble_ends(m, s, w);
  assemble_sources(m, s, d, w);
  for (int i = 0; i < w.chain_count; ++i)
    assemble_chain(m, s, w.chains[i], again, w);  // last: looks at what is there already
  const int bad = eliminate(m.plan, w.diagonal, w.values, w.x);
  return bad < 0 ? first_beyond(w.x, 1e100) : bad;
}

}  // namespace

double row_volume(const FlowModel& m, int row, double from, double to) noexcept {
  return taken_up(m, std::size_t(row), from, to - from);
}

FlowReport advance(const FlowModel& m, const FlowInput& in, std::span<OpeningFlow> flows, FlowState& s,
                   FlowWork& w) noexcept {
  FlowReport report;
  const Drive d = drive(m, s);
  for (OpeningFlow& f : flows) f = OpeningFlow{};
  gather_sites(m, in, s, w, report);
  find_fed(m, s, w);

  expect(m, s, w);
  int bad = solve(m, s, d, false, w);
  for (; report.solves <= kAgain && bad < 0 && expect_again(m, s, w); ++report.solves) bad = solve(m, s, d, true, w);
  if (bad < 0) bad = first_beyond(w.x, 1e12);
  report.heart_rate = d.rate, report.heart_pressure = d.arterial;
  if (bad >= 0) {
    report.flags |= FlowReport::kNonFinite;
    report.first_bad = bad;
    return report;
  }
  update_ends(m, s, w);
  update_chains(m, flows, s, w);
  plain_cells(m, w, [&](int first, int last) { update_cells(m, first, last, s, w); });
  update_rows(m, s, w, report);
  update_patient(m, in, d, s);
  return report;
}

Vitals vitals(const FlowModel& m, const FlowState& s) noexcept {
  const LossResponse now = response_of(m, s);
  const double pulse = m.heart.systolic - m.heart.diastolic, mean = m.heart.diastolic + m.beat_mean * pulse;
  const double left = now.mean * mean, beats = now.mean * now.pulse * pulse;
  return {m.heart.rate * now.rate, left + (1 - m.beat_mean) * beats, left - m.beat_mean * beats, left};
}

}  // namespace trocar::vessels

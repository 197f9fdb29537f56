#include <cmath>
#include <cstddef>

#include <trocar/numerics/portable.hpp>
#include <trocar/vessels/connected.hpp>
#include <trocar/vessels/sites.hpp>

namespace trocar::vessels {
namespace {

using Kind = FlowSite::Kind;
constexpr double kLeastPiece = 0.01;       // of a cell, so that nearest places keep apart
constexpr double kSingular = 1e-9;         // of a diagonal: the piece between two closed places floats
constexpr double kFloor = 1e-4;            // of an orifice's flow at 10 kPa: below it, its law is continued straight
constexpr double kOozes = 2000;            // how far below the pressure around it a vein oozes: 15 mmHg [Pa]
constexpr double kFar = 0.05, kNear = 50;  // how far off an orifice may be: of its pressure, and [Pa]
constexpr int kRounds = 4;                 // of Newton's method for the orifices of a chain

bool finite(double x) { return x - x == 0; }

/// The order of places: along the cells, a clip before an opening, lower slots first.
bool before(const FlowSite& a, const FlowSite& b) {
  if (a.cell != b.cell) return a.cell < b.cell;
  if (a.at != b.at) return a.at < b.at;
  if ((a.kind == Kind::clip) != (b.kind == Kind::clip)) return a.kind == Kind::clip;
  return a.index < b.index;
}

bool placed(const FlowModel& m, int segment, double s) {
  return segment >= 0 && segment < int(m.segments.size()) && s >= 0 && s <= 1;
}

void complain(FlowReport& report, std::uint32_t flag, std::size_t index) {
  if (!(report.flags & flag) && report.first_bad < 0) report.first_bad = int(index);
  report.flags |= flag;
}

/// Keeps w.sites sorted.
void insert(FlowWork& w, const FlowSite& site) {
  int i = w.site_count++;
  for (; i > 0 && before(site, w.sites[i - 1]); --i) w.sites[i] = w.sites[i - 1];
  w.sites[i] = site;
}

void gather_clip(const FlowModel& m, const Occlusion& clip, int index, ClipState& slot, FlowWork& w) {
  const FlowSegment& segment = m.segments[clip.segment];
  FlowSite site;
  site.segment = clip.segment, site.index = index;
  site.cell = cell_at(segment, clip.s, &site.at);
  site.closed = clip.cover >= m.settings.closing_cover;
  const double open = 1 - clip.cover;
  if (!site.closed) site.resistance = segment.cut_resistance * (1 / (open * open) - 1);
  slot.at = site.at;
  slot.closed = site.closed;
  site.fed[0] = slot.cell != site.cell;  // new: its piece has no flow yet
  slot.cell = site.cell;
  insert(w, site);
}

void gather_opening(const FlowModel& m, const Opening& o, int index, OpeningState& slot, FlowWork& w) {
  const FlowSegment& segment = m.segments[o.segment];
  FlowSite site;
  site.kind = o.kind == Opening::Kind::cut ? Kind::cut : Kind::hole;
  site.segment = o.segment, site.index = index;
  site.cell = cell_at(segment, o.s, &site.at);
  site.outside = o.outside;
  if (slot.segment != o.segment || slot.kind != int(o.kind)) slot = OpeningState{};
  site.fed[0] = slot.cell != site.cell;
  slot.segment = o.segment, slot.kind = int(o.kind), slot.cell = site.cell, slot.at = site.at;
  const double sealed = o.sealed > 0 ? (o.sealed < 1 ? o.sealed : 1) : 0;
  const double area = o.area * (1 - sealed) * (1 - slot.clot);
  site.open[0] = site.open[1] = area > 1e-6 * o.area && area > 1e-14;
  if (site.open[0]) {
    const double through = m.settings.discharge * area;
    site.orifice = m.blood.density / (2 * through * through);
    const double radius = segment.radius + segment.taper * o.s, lumen = portable::pi * radius * radius;
    site.ooze = segment.vein ? m.settings.ooze_speed * (area < lumen ? area : lumen) : 0;
  }
  if (o.area < m.settings.clot_area && slot.clot < 1) {
    const double share = o.area / m.settings.clot_area;
    const double time = m.settings.clot_time_small + share * (m.settings.clot_time_large - m.settings.clot_time_small);
    slot.clot += m.settings.tick / time;
    if (!(slot.clot < 1)) slot.clot = 1;
  }
  insert(w, site);
}

double& flow_before(FlowState& s, const FlowSite& site) {
  return site.kind == Kind::clip ? s.clips[site.index].before : s.openings[site.index].before;
}
double flow_before(const FlowState& s, const FlowSite& site) {
  return site.kind == Kind::clip ? s.clips[site.index].before : s.openings[site.index].before;
}

/// Groups sites of the same cell; a place that is new parts a piece in two of the same flow.
void chain_up(FlowState& s, FlowWork& w) {
  w.chain_count = 0;
  int points = 0;
  for (int i = 0; i < w.site_count;) {
    FlowChain chain;
    chain.cell = w.sites[i].cell, chain.first_site = i, chain.first_point = points;
    for (; i < w.site_count && w.sites[i].cell == chain.cell; ++i) {
      w.sites[i].point = points + chain.points;
      chain.points += w.sites[i].kind == Kind::hole ? 1 : 2;
    }
    chain.sites = i - chain.first_site;
    points += chain.points + 1;
    double flow = s.q[chain.cell];
    for (int k = i; k-- > chain.first_site;) {
      if (w.sites[k].fed[0]) flow_before(s, w.sites[k]) = flow;
      flow = flow_before(s, w.sites[k]);
    }
    w.chains[w.chain_count++] = chain;
  }
}

/// part_fed of each node's root: some source is in that part.
void mark_parts(const FlowModel& m, FlowWork& w) {
  for (std::int8_t& b : w.blocked) b = 0;
  for (int i = 0; i < w.site_count; ++i)
    if (w.sites[i].closed || w.sites[i].kind == Kind::cut) w.blocked[w.sites[i].segment] = 1;
  for (int i = 0; i < m.nodes; ++i) w.part[i] = i, w.part_fed[i] = 0;
  for (std::size_t i = 0; i < m.segments.size(); ++i) {
    if (w.blocked[i]) continue;
    const int a = root(w.part, m.segments[i].from), b = root(w.part, m.segments[i].to);
    w.part[a > b ? a : b] = a > b ? b : a;
  }
  for (const FlowSource& source : m.sources) w.part_fed[root(w.part, source.node)] = 1;
}

/// Carries what feeds one end of a segment along its sites, up to what closes or parts it.
struct Walk {
  bool fed;
  void pass(FlowSite& site, int side) {
    if (site.kind == Kind::hole) site.fed[0] |= fed;
    if (site.kind == Kind::cut) site.fed[side] = fed;
    if (site.closed || site.kind == Kind::cut) fed = false;
  }
};

}  // namespace

void gather_sites(const FlowModel& m, const FlowInput& in, FlowState& s, FlowWork& w, FlowReport& report) noexcept {
  w.site_count = 0;
  for (std::size_t i = 0; i < s.clips.size(); ++i) {
    const Occlusion clip = i < in.clips.size() ? in.clips[i] : Occlusion{};
    const bool wanted = clip.segment != -1 && !(clip.cover <= 0);
    const bool good = placed(m, clip.segment, clip.s) && finite(clip.cover);
    if (wanted && !good) complain(report, FlowReport::kBadClip, i);
    if (wanted && good)
      gather_clip(m, clip, int(i), s.clips[i], w);
    else
      s.clips[i] = ClipState{};
  }
  for (std::size_t i = 0; i < s.openings.size(); ++i) {
    const Opening o = i < in.openings.size() ? in.openings[i] : Opening{};
    const bool wanted = o.segment != -1 && !(o.area <= 0);
    const bool good =
        placed(m, o.segment, o.s) && o.area < 1 && o.outside > -1e6 && o.outside < 1e6 && finite(o.sealed);
    if (wanted && !good) complain(report, FlowReport::kBadOpening, i);
    if (wanted && good)
      gather_opening(m, o, int(i), s.openings[i], w);
    else
      s.openings[i] = OpeningState{};
  }
  if (in.clips.size() > s.clips.size()) complain(report, FlowReport::kBadClip, s.clips.size());
  if (in.openings.size() > s.openings.size()) complain(report, FlowReport::kBadOpening, s.openings.size());
  chain_up(s, w);
}

void find_fed(const FlowModel& m, FlowState& s, FlowWork& w) noexcept {
  if (w.site_count == 0) return;
  mark_parts(m, w);
  for (int i = 0; i < w.site_count; ++i) w.sites[i].fed[0] = w.sites[i].fed[1] = false;
  for (int first = 0, last; first < w.site_count; first = last) {
    const FlowSegment& segment = m.segments[w.sites[first].segment];
    for (last = first; last < w.site_count && w.sites[last].segment == w.sites[first].segment;) ++last;
    Walk forth{w.part_fed[root(w.part, segment.from)] != 0}, back{w.part_fed[root(w.part, segment.to)] != 0};
    for (int i = first; i < last; ++i) forth.pass(w.sites[i], 0);
    for (int i = last; i-- > first;) back.pass(w.sites[i], 1);
  }
  for (int i = 0; i < w.site_count; ++i) {
    FlowSite& site = w.sites[i];
    if (site.kind == Kind::clip) continue;
    OpeningState& slot = s.openings[site.index];
    std::int32_t* ticks[2] = {&slot.ticks_cut_off, &slot.ticks_cut_off_other};
    for (int side = 0; side < 2; ++side) {
      if (site.fed[side])
        *ticks[side] = 0;
      else if (*ticks[side] >= m.drain_ticks)
        site.open[side] = false;
      else
        ++*ticks[side];
    }
  }
}

namespace {

/// Pieces and clips between the chain's places.
void lay_pieces(const FlowState& s, const FlowChain& chain, const CellTerms& terms, FlowWork& w) {
  FlowPoint* point = w.points.data() + chain.first_point;
  double at = 0;
  for (int k = 0; k <= chain.sites; ++k) {
    const bool last = k == chain.sites;
    const FlowSite* site = last ? nullptr : &w.sites[chain.first_site + k];
    double share = (last ? 1 : site->at) - at;
    if (share < kLeastPiece) share = kLeastPiece;
    const double inertia = terms.inertia * share;
    point->g = 1 / (inertia + terms.resistance * share);
    point->s = point->g * inertia * (last ? s.q[chain.cell] : flow_before(s, *site));
    point->out = point->out0 = 0;
    ++point;
    if (last) break;
    at = site->at;
    if (site->kind == Kind::hole) continue;
    point->g = site->kind == Kind::clip && !site->closed ? 1 / site->resistance : 0;
    point->s = point->out = point->out0 = 0;
    ++point;
  }
}

/// Pressures at the places for given pressures at the ends (`forced`: with what drives them from within).
/// Thomas' algorithm; a piece that floats between closed places gets the pressure 0, and no flow.
void solve_places(FlowPoint* p, int n, double end_a, double end_b, bool forced, double FlowPoint::*result) {
  for (int k = 0; k < n; ++k) {
    const double before_c = k > 0 ? p[k - 1].scratch[0] : 0, before_d = k > 0 ? p[k - 1].scratch[1] : end_a;
    const double diagonal = p[k].g + p[k + 1].g + p[k].out;
    const double pivot = diagonal - p[k].g * before_c;
    const double inverse = pivot > kSingular * diagonal ? 1 / pivot : 0;
    double right = p[k].g * before_d;
    if (k == n - 1) right += p[k + 1].g * end_b;
    if (forced) right += p[k].s - p[k + 1].s - p[k].out0;
    p[k].scratch[0] = p[k + 1].g * inverse;
    p[k].scratch[1] = right * inverse;
  }
  p[n - 1].*result = p[n - 1].scratch[1];
  for (int k = n - 1; k-- > 0;) p[k].*result = p[k].scratch[1] + p[k].scratch[0] * (p[k + 1].*result);
}

/// The orifice's law orifice q^2 = P - outside as a straight line through the flow guessed, or closed.
void straighten(const FlowSite& site, int side, double pressure, FlowPoint& point) {
  const double q0 = point.guess;
  point.out = point.out0 = 0;
  if (!site.open[side]) return;
  if (q0 > 0) {
    point.out = 1 / (2 * site.orifice * q0);
    point.out0 = q0 / 2 - point.out * site.outside;
  } else if (site.fed[side] && pressure > site.outside - kOozes) {
    point.out = site.ooze / kOozes;
    point.out0 = site.ooze - point.out * site.outside;
  }
}

/// A better q0 from the pressure that came of the last one.
double improved(const FlowSite& site, const FlowPoint& point, double pressure) {
  const double q0 = point.guess;
  const double over = pressure - site.outside;
  const double least = kFloor * std::sqrt(1e4 / site.orifice);
  const double q = q0 > 0 ? point.out * pressure + point.out0 : over > 0 ? std::sqrt(over / site.orifice) : 0;
  if (!(q > 0)) return 0;
  const double enough = q > least ? q : least;
  return enough > site.ooze * (1 + over / kOozes) ? enough : 0;
}

int sides(const FlowSite& site) { return site.kind == Kind::clip ? 0 : site.kind == Kind::cut ? 2 : 1; }

/// Calls body(site, side, point) for all that blood can leave a chain by.
template <class F>
void each_outlet(const FlowChain& chain, FlowWork& w, F&& body) {
  for (int k = 0; k < chain.sites; ++k) {
    const FlowSite& site = w.sites[chain.first_site + k];
    for (int side = 0; side < sides(site); ++side) body(site, side, w.points[site.point + side]);
  }
}

/// A piece and the end that gives way to its flow, as one piece.
void soften(FlowPoint& piece, const ChainEnd& end) {
  const double share = 1 / (1 + piece.g / end.conductance);
  piece.g *= share;
  piece.s *= share;
}

/// The orifices' flows if all beyond the next rows stood still: Newton's method.
void guess_locally(const FlowState& s, const FlowChain& chain, const ChainEnd& a, const ChainEnd& b, FlowWork& w) {
  FlowPoint* points = w.points.data() + chain.first_point;
  const FlowPoint head = points[0], tail = points[chain.points];
  soften(points[0], a);
  soften(points[chain.points], b);
  solve_places(points, chain.points, a.pressure, b.pressure, true, &FlowPoint::fixed);  // all closed, to begin with
  each_outlet(chain, w, [&](const FlowSite& site, int side, FlowPoint& point) {
    const double last = s.openings[site.index].flow[side], over = point.fixed - site.outside;
    point.guess = over > 0 && site.open[side] ? (last > 0 ? last : std::sqrt(over / site.orifice)) : 0;
    straighten(site, side, point.fixed, point);
  });
  for (int round = 0; round < kRounds; ++round) {
    solve_places(points, chain.points, a.pressure, b.pressure, true, &FlowPoint::fixed);
    each_outlet(chain, w, [&](const FlowSite& site, int side, FlowPoint& point) {
      if (!site.open[side]) return;
      point.guess = improved(site, point, point.fixed);
      straighten(site, side, point.fixed, point);
    });
  }
  points[0].g = head.g, points[0].s = head.s;
  points[chain.points].g = tail.g, points[chain.points].s = tail.s;
}

}  // namespace

void reduce_chain(const FlowState& s, FlowChain& chain, const CellTerms& terms, const ChainEnd& a, const ChainEnd& b,
                  bool again, FlowWork& w) noexcept {
  lay_pieces(s, chain, terms, w);
  chain.conductance_a = a.conductance, chain.conductance_b = b.conductance;
  if (again)
    each_outlet(chain, w, [](const FlowSite& site, int side, FlowPoint& point) {
      straighten(site, side, point.scratch[0], point);  // the pressure that guess_again() saw
    });
  else
    guess_locally(s, chain, a, b, w);
  FlowPoint* points = w.points.data() + chain.first_point;
  solve_places(points, chain.points, 0, 0, true, &FlowPoint::fixed);
  solve_places(points, chain.points, 1, 0, false, &FlowPoint::from_a);
  solve_places(points, chain.points, 0, 1, false, &FlowPoint::from_b);
}

bool guess_again(const FlowChain& chain, double end_a, double end_b, FlowWork& w) noexcept {
  FlowPoint* points = w.points.data() + chain.first_point;
  bool far = false;
  each_outlet(chain, w, [&](const FlowSite& site, int side, FlowPoint& point) {
    if (!site.open[side]) return;
    const double pressure = point.fixed + point.from_a * end_a + point.from_b * end_b, over = pressure - site.outside;
    const double q = point.guess > 0 ? point.out * pressure + point.out0 : 0;
    const double due = over > 0 ? over : 0, off = due - site.orifice * q * q;
    far = far || off > kFar * due + kNear || off < -kFar * due - kNear;
    if (point.guess > 0) {
      point.guess = improved(site, point, pressure);
    } else if (over > kNear) {  // no more than the pieces beside it let through
      const int k = int(&point - points);
      const double left = point.g, right = points[k + 1].g;
      const double a = k == 0 ? left / (1 + left / chain.conductance_a) : left;
      const double b = k + 1 == chain.points ? right / (1 + right / chain.conductance_b) : right;
      const double most = over * (a + b), through = std::sqrt(over / site.orifice);
      point.guess = most < through ? most : through;
    }
    point.scratch[0] = pressure;
  });
  return far;
}

namespace {

/// Flow into the place k from the one before it (the ends are places 0 - 1 and `points`).
double piece_flow(const FlowPoint* p, int points, int k, double end_a, double end_b) {
  const auto pressure = [&](int i) {
    if (i < 0) return end_a;
    return i == points ? end_b : p[i].fixed + p[i].from_a * end_a + p[i].from_b * end_b;
  };
  return p[k].g * (pressure(k - 1) - pressure(k)) + p[k].s;
}

/// What flowed for a tick: returns whole picolitres, keeps the rest. A flow that came out below zero is owed first.
std::int64_t book(double flow, double tick, double& remainder) {
  remainder += flow * tick / kPicolitre;
  if (!(remainder >= 1)) return 0;
  const std::int64_t whole = std::int64_t(remainder);
  remainder -= double(whole);
  return whole;
}

/// New flow of a piece from its mean over the tick; nothing continues moving where nothing can.
double next_flow(double flow, double mean, double implicitness) {
  return mean == 0 ? 0 : flow + (mean - flow) / implicitness;
}

}  // namespace

void finish_chain(const FlowModel& m, const FlowChain& chain, double end_a, double end_b, std::span<OpeningFlow> flows,
                  FlowState& s, FlowWork& w) noexcept {
  const FlowPoint* p = w.points.data() + chain.first_point;
  const double theta = m.settings.implicitness;
  for (int k = 0; k < chain.sites; ++k) {
    const FlowSite& site = w.sites[chain.first_site + k];
    const int place = site.point - chain.first_point;
    double& flow = flow_before(s, site);
    flow = next_flow(flow, piece_flow(p, chain.points, place, end_a, end_b), theta);
    if (site.kind == Kind::clip) continue;
    OpeningState& slot = s.openings[site.index];
    OpeningFlow told;
    for (int side = 0; side < sides(site); ++side) {
      const FlowPoint& point = p[place + side];
      slot.pressure[side] = point.fixed + point.from_a * end_a + point.from_b * end_b;
      const double out = point.out * slot.pressure[side] + point.out0;
      told.picolitres[side] = book(out, m.settings.tick, slot.remainder[side]);
      s.bled += told.picolitres[side];
      slot.flow[side] = out > 0 ? out : 0;
      told.flow[side] = slot.flow[side], told.pressure[side] = slot.pressure[side], told.fed[side] = site.fed[side];
    }
    told.clot = slot.clot;
    if (std::size_t(site.index) < flows.size()) flows[site.index] = told;
  }
  double& flow = s.q[chain.cell];
  flow = next_flow(flow, piece_flow(p, chain.points, chain.points, end_a, end_b), theta);
  s.dq[chain.cell] = 0;
}

}  // namespace trocar::vessels

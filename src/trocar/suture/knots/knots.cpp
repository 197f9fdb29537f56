#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <trocar/numerics/pivoted_qr.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/suture/knots/knots.hpp>

namespace trocar::suture {
namespace {

constexpr int kViews = 64;                     // directions from which a picture is made
constexpr std::size_t kThrow = 3, kHitch = 2;  // crossings, at least
constexpr double kStraight = 1.25;             // arc over chord of a side that does not turn: a post
constexpr double kUnlikely = 1e-6;             // that a picture is right which shows another knot
constexpr double kSure = 0.25;                 // share of pictures that need not be compared with earlier ones
constexpr double kTrusted = 0.15;              // of a knot upon which the next throw is laid
constexpr double kFew = 0.03;                  // of a knot that has another throw, or one less: two pictures of 64
constexpr int kTwice = 2, kOften = 12;         // readings in a row that tell of such a knot, of any other one
constexpr double kTurned = 1.5;                // of one that turns round it

/// Where both sides cross in a picture.
struct Crossing {
  double s = 0, t = 0;  ///< arc lengths, s on the side of lower ones [m]
  int sign = 0;
  bool over = false;  ///< the side of lower s is nearer to the eye
  Vec3d place;
};

/// Directions of a half sphere, evenly; the last parts of a golden angle.
Vec3d view(int i) {
  const double z = (i + 0.5) / kViews, r = std::sqrt(1 - z * z), a = 2.399963229728653 * i;
  return {r * portable::cos(a), r * portable::sin(a), z};
}

struct Flat {
  double x = 0, y = 0, z = 0;
};

/// Elements of either side that may cross.
using Pairs = std::vector<std::array<std::int32_t, 2>>;

/// @param split  where the one side ends and the other begins; 0: of the thread with itself anywhere
/// @param apart  nearer than this [m]; 0: anything
Pairs pairs_of(std::span<const Vec3d> p, std::size_t split, double apart) {
  Pairs pairs;
  for (std::size_t i = 0; split == 0 ? i + 1 < p.size() : i + 1 <= split; ++i)
    for (std::size_t j = std::max(split, i + 2); j + 1 < p.size(); ++j) {
      const Vec3d off = 0.5 * (p[i] + p[i + 1] - p[j] - p[j + 1]);
      if (apart <= 0 || dot(off, off) < apart * apart) pairs.push_back({std::int32_t(i), std::int32_t(j)});
    }
  return pairs;
}

std::vector<Crossing> crossings_from(std::span<const Vec3d> p, std::span<const double> arc, const Pairs& pairs,
                                     Vec3d eye) {
  const Vec3d u = any_perpendicular(eye), v = cross(eye, u);
  std::vector<Flat> flat(p.size());
  for (std::size_t i = 0; i < p.size(); ++i) flat[i] = {dot(p[i], u), dot(p[i], v), dot(p[i], eye)};
  std::vector<Crossing> found;
  for (const auto& pair : pairs) {
    const std::size_t i = std::size_t(pair[0]), j = std::size_t(pair[1]);
    const Flat &a = flat[i], &b = flat[i + 1], &c = flat[j], &d = flat[j + 1];
    if (std::max(a.x, b.x) < std::min(c.x, d.x) || std::max(c.x, d.x) < std::min(a.x, b.x)) continue;
    if (std::max(a.y, b.y) < std::min(c.y, d.y) || std::max(c.y, d.y) < std::min(a.y, b.y)) continue;
    const double abx = b.x - a.x, aby = b.y - a.y, cdx = d.x - c.x, cdy = d.y - c.y, det = abx * cdy - aby * cdx;
    if (det == 0) continue;
    const double f = ((c.x - a.x) * cdy - (c.y - a.y) * cdx) / det, g = ((c.x - a.x) * aby - (c.y - a.y) * abx) / det;
    if (!(f >= 0 && f < 1 && g >= 0 && g < 1)) continue;
    const double high = a.z + f * (b.z - a.z) - (c.z + g * (d.z - c.z));
    // With both strands running on, the crossing is right-handed if over x under looks away from the eye ...
    const int sign = (high > 0) == (det > 0) ? 1 : -1;
    found.push_back({arc[i] + f * (arc[i + 1] - arc[i]), arc[j] + g * (arc[j + 1] - arc[j]), sign, high > 0,
                     0.5 * (p[i] + f * (p[i + 1] - p[i]) + p[j] + g * (p[j + 1] - p[j]))});
  }
  // from the tissue outwards on the side of lower s
  std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) { return a.s > b.s; });
  return found;
}

/// Two crossings that follow each other on both sides, with the same side on top of both, come undone.
bool undo_one(std::vector<Crossing>& list) {
  std::vector<std::size_t> by_t(list.size()), rank(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) by_t[i] = i;
  std::sort(by_t.begin(), by_t.end(), [&](std::size_t a, std::size_t b) { return list[a].t < list[b].t; });
  for (std::size_t i = 0; i < list.size(); ++i) rank[by_t[i]] = i;
  for (std::size_t i = 0; i + 1 < list.size(); ++i) {
    const std::size_t a = rank[i], b = rank[i + 1];
    if ((a > b ? a - b : b - a) != 1 || list[i].over != list[i + 1].over) continue;
    list.erase(list.begin() + std::ptrdiff_t(i), list.begin() + std::ptrdiff_t(i) + 2);
    return true;
  }
  return false;
}

/// What is outermost and no throw: two ends that merely lie over each other.
void drop_loose_ends(std::vector<Crossing>& list, std::size_t least) {
  while (!list.empty()) {
    std::size_t run = 1;
    while (run < list.size() && list[list.size() - 1 - run].sign == list.back().sign) ++run;
    if (run >= least) return;
    list.resize(list.size() - run);
  }
}

KnotThrow throw_of(const std::vector<Crossing>& list, std::size_t first, std::size_t count) {
  KnotThrow t;
  t.turns = std::int32_t(count / 2);
  t.sign = list[first].sign;
  for (std::size_t i = first; i < first + count; ++i) {
    t.s += list[i].s / double(count);
    t.t += list[i].t / double(count);
    t.place += list[i].place / double(count);
  }
  return t;
}

/// Crossings of one sign in a row are a throw of an odd number; an even one is of several, or has lost one to the eye.
void read_throws(const std::vector<Crossing>& list, std::size_t least, KnotReading& knot) {
  for (std::size_t i = 0; i < list.size();) {
    std::size_t run = 1;
    while (i + run < list.size() && list[i + run].sign == list[i].sign) ++run;
    std::size_t left = run, at = i;
    while (left >= least && knot.count < kMostThrows) {
      // of an even number the first throw has what the others leave: 6 = 3 + 3, 8 = 5 + 3; 4 is a double one
      const std::size_t take = least < 3 ? 2 : (left % 2 == 1 || left == 4 ? left : left - 3);
      knot.throws[std::size_t(knot.count++)] = throw_of(list, at, take);
      at += take;
      left -= take;
    }
    i += run;
  }
}

/// A throw of n turns is a torus knot of determinant 2 n + 1, throws upon each other are sums of these, and of a sum it
/// is the product.
double determinant_of(const std::vector<std::int32_t>& throws) {
  double product = 1;
  for (const std::int32_t turns : throws) product *= 2 * std::abs(turns) + 1;
  return product;
}

double arc_over_chord(std::span<const Vec3d> p, std::span<const double> arc, double from, double to) {
  const auto at = [&](double s) {
    const std::size_t i = std::size_t(std::clamp(std::lower_bound(arc.begin(), arc.end(), s) - arc.begin(),
                                                 std::ptrdiff_t(1), std::ptrdiff_t(arc.size() - 1)));
    const double f = (s - arc[i - 1]) / std::max(1e-12, arc[i] - arc[i - 1]);
    return p[i - 1] + f * (p[i] - p[i - 1]);
  };
  const double chord = length(at(to) - at(from));
  return chord > 0 ? std::fabs(to - from) / chord : 1e9;
}

/// Arc lengths between which both sides cross.
struct Span {
  double s_low = 1e9, s_high = -1e9, t_low = 1e9, t_high = -1e9;
};
Span span_of(const std::vector<Crossing>& list) {
  Span side;
  for (const Crossing& c : list) {
    side.s_low = std::min(side.s_low, c.s), side.s_high = std::max(side.s_high, c.s);
    side.t_low = std::min(side.t_low, c.t), side.t_high = std::max(side.t_high, c.t);
  }
  return side;
}
/// Is one side straight, and the other taken round it?
bool is_post(std::span<const Vec3d> p, std::span<const double> arc, const std::vector<Crossing>& list) {
  if (list.size() < 2) return false;
  const Span side = span_of(list);
  const double one = arc_over_chord(p, arc, side.s_low, side.s_high);
  const double other = arc_over_chord(p, arc, side.t_low, side.t_high);
  return std::min(one, other) < kStraight && std::max(one, other) > kTurned;
}

KnotKind kind_of(const KnotReading& knot, bool post) {
  if (knot.count == 0) return KnotKind::none;
  if (knot.count == 1) return KnotKind::half;
  if (post) return KnotKind::slip;
  bool square = true;
  for (int i = 1; i < knot.count; ++i)
    square = square && knot.throws[std::size_t(i)].sign == -knot.throws[std::size_t(i - 1)].sign;
  return square ? KnotKind::square : KnotKind::granny;
}

/// The middle of the longest stretch between two crossings, in the picture with the fewest.
std::size_t widest_loop(std::span<const Vec3d> p, std::span<const double> arc) {
  const Pairs pairs = pairs_of(p, 0, 0);
  std::vector<double> fewest;
  for (int i = 0; i < kViews; ++i) {
    std::vector<double> places;
    for (const Crossing& c : crossings_from(p, arc, pairs, view(i))) places.push_back(c.s), places.push_back(c.t);
    if (places.size() < 4 || (!fewest.empty() && places.size() >= fewest.size())) continue;
    fewest = std::move(places);
  }
  if (fewest.empty()) return p.size() / 2;
  std::sort(fewest.begin(), fewest.end());
  double most = 0, at = 0;
  for (std::size_t i = 1; i < fewest.size(); ++i)
    if (fewest[i] - fewest[i - 1] > most) most = fewest[i] - fewest[i - 1], at = 0.5 * (fewest[i] + fewest[i - 1]);
  return std::size_t(std::clamp(std::lower_bound(arc.begin(), arc.end(), at) - arc.begin(), std::ptrdiff_t(1),
                                std::ptrdiff_t(p.size() - 2)));
}

/// The determinant of the knot that the thread is when its ends are joined above all of it, from the crossings of all
/// of it with itself in one picture [colourings of arcs: twice the one on top is the sum of the two below].
double determinant_from(const std::vector<Crossing>& list) {
  struct Pass {
    double s = 0;
    std::size_t crossing = 0;
    bool over = false;
  };
  const std::size_t n = list.size();
  if (n < 3) return 1;
  std::vector<Pass> along;
  for (std::size_t i = 0; i < n; ++i)
    along.push_back({list[i].s, i, list[i].over}), along.push_back({list[i].t, i, !list[i].over});
  std::sort(along.begin(), along.end(), [](const Pass& a, const Pass& b) { return a.s < b.s; });
  std::vector<double> colours(n * n);  // a row per crossing, a column per arc from one way below to the next
  std::size_t arc = 0;
  for (const Pass& pass : along) {
    double* row = &colours[pass.crossing * n];
    if (pass.over) {
      row[arc] += 2;
      continue;
    }
    row[arc] -= 1;
    arc = (arc + 1) % n;
    row[arc] -= 1;
  }
  // any row and any column may be left out
  std::vector<double> minor;
  for (std::size_t i = 0; i + 1 < n; ++i)
    minor.insert(minor.end(), colours.begin() + std::ptrdiff_t(i * n), colours.begin() + std::ptrdiff_t(i * n + n - 1));
  return std::round(std::fabs(numerics::determinant(int(n) - 1, minor.data())));
}

/// As most pictures tell: one in which two crossings coincide may err.
double determinant_seen(std::span<const Vec3d> p, std::span<const double> arc) {
  constexpr int kEvery = 9;  // pictures
  constexpr std::size_t kMost = 200;
  const Pairs pairs = pairs_of(p, 0, 0);
  std::vector<double> seen;
  for (int i = 0; i < kViews; i += kEvery) {
    const std::vector<Crossing> list = crossings_from(p, arc, pairs, view(i));
    if (list.size() <= kMost) seen.push_back(determinant_from(list));
  }
  double best = -1;
  std::ptrdiff_t most = 0;
  for (const double d : seen) {
    const std::ptrdiff_t votes = std::count(seen.begin(), seen.end(), d);
    if (votes > most) most = votes, best = d;
  }
  return best;
}

/// Throws in short: turns with their signs.
std::vector<std::int32_t> shorthand(const std::vector<Crossing>& list, std::size_t least) {
  KnotReading knot;
  read_throws(list, least, knot);
  std::vector<std::int32_t> out;
  for (int i = 0; i < knot.count; ++i)
    out.push_back(knot.throws[std::size_t(i)].sign * knot.throws[std::size_t(i)].turns);
  return out;
}

/// What most pictures tell.
struct Seen {
  std::vector<Crossing> list;  ///< of the picture with fewest
  double agree = 0;            ///< share of pictures, 0 where it is of another knot than the thread's
};
/// The crossings of a picture of which most others tell the same throws; of equally many, of the one with fewest. Those
/// that tell of a knot that the thread is not have no vote while there are others.
Seen most_seen(std::span<const Vec3d> p, std::span<const double> arc, std::size_t split, double apart,
               std::size_t least, double determinant) {
  struct Reading {
    std::vector<std::int32_t> throws;
    std::vector<Crossing> list;
    double votes = 0;  ///< a picture with fewer crossings says more
    int pictures = 0;  ///< that fit the determinant
  };
  const Pairs pairs = pairs_of(p, split, apart);
  std::vector<Reading> readings;
  for (int i = 0; i < kViews; ++i) {
    std::vector<Crossing> list = crossings_from(p, arc, pairs, view(i));
    while (undo_one(list)) {
    }
    drop_loose_ends(list, least);
    const std::vector<std::int32_t> throws = shorthand(list, least);
    const bool fits = determinant_of(throws) == determinant;
    const double weight = (fits ? 1 : kUnlikely) / double(1 + list.size());
    const auto known =
        std::find_if(readings.begin(), readings.end(), [&](const Reading& r) { return r.throws == throws; });
    if (known == readings.end()) {
      readings.push_back({throws, std::move(list), weight, fits ? 1 : 0});
      continue;
    }
    known->votes += weight;
    known->pictures += fits ? 1 : 0;
    if (list.size() < known->list.size()) known->list = std::move(list);
  }
  Reading& most = *std::max_element(readings.begin(), readings.end(),
                                    [](const Reading& a, const Reading& b) { return a.votes < b.votes; });
  return {std::move(most.list), most.pictures / double(kViews)};
}

}  // namespace

const char* name_of(KnotKind kind) noexcept {
  constexpr const char* kNames[] = {"none", "half", "square", "granny", "slip"};
  return kNames[std::size_t(kind)];
}

KnotReading read_knot(std::span<const Vec3d> p, const KnotQuestion& question) {
  KnotReading knot;
  if (p.size() < 8) return knot;
  std::vector<double> arc(p.size());
  for (std::size_t i = 1; i < p.size(); ++i)
    arc[i] = arc[i - 1] + (question.spacing > 0 ? question.spacing : length(p[i] - p[i - 1]));
  std::size_t split = 0;
  if (question.split < 0)
    split = widest_loop(p, arc);
  else
    split = std::size_t(std::clamp(std::lower_bound(arc.begin(), arc.end(), question.split) - arc.begin(),
                                   std::ptrdiff_t(1), std::ptrdiff_t(p.size() - 2)));
  const double determinant = determinant_seen(p, arc);
  Seen best = most_seen(p, arc, split, question.apart, kThrow, determinant);
  bool post = is_post(p, arc, best.list);
  if (post || best.list.empty()) {
    Seen hitches = most_seen(p, arc, split, question.apart, kHitch, determinant);
    post = is_post(p, arc, hitches.list) && hitches.agree > 0;
    if (post) best = std::move(hitches);
  }
  knot.crossings = std::int32_t(best.list.size());
  knot.determinant = determinant, knot.agree = best.agree;
  read_throws(best.list, post ? kHitch : kThrow, knot);
  knot.tail = arc[split], knot.standing = arc.back() - arc[split];
  if (knot.count == 0) return knot;
  const Span side = span_of(best.list);
  knot.place = knot.throws[0].place;
  knot.tail = side.s_low;
  knot.standing = arc.back() - side.t_high;
  knot.kind = kind_of(knot, post);
  return knot;
}

namespace {

/// As far as both have throws.
bool same_throws(const KnotReading& a, const KnotReading& b) noexcept {
  for (int i = 0; i < std::min(a.count, b.count); ++i)
    if (a.throws[std::size_t(i)].turns != b.throws[std::size_t(i)].turns ||
        a.throws[std::size_t(i)].sign != b.throws[std::size_t(i)].sign)
      return false;
  return true;
}

}  // namespace

bool KnownKnot::convinces(const KnotReading& seen) noexcept {
  const bool goes_on = m_knot.agree < kTrusted || same_throws(m_knot, seen);
  if (seen.agree >= (goes_on ? kFew : kSure)) return true;
  m_told = seen.count == m_doubted.count && same_throws(seen, m_doubted) ? m_told + 1 : 1;
  m_doubted = seen;
  return m_told >= (goes_on ? kTwice : kOften);
}

const KnotReading& KnownKnot::update(const KnotReading& seen) noexcept {
  const bool same = m_knot.agree > 0 && seen.determinant == m_knot.determinant;
  if (seen.agree > 0 && (same ? seen.agree > std::min(kSure, m_knot.agree) : convinces(seen))) {
    m_told = 0;
    return m_knot = seen;
  }
  if (seen.count == 0 || m_knot.count == 0) return m_knot;
  m_knot.place = seen.place, m_knot.tail = seen.tail, m_knot.standing = seen.standing;
  return m_knot;
}

double turns_around(std::span<const Vec3d> p, Vec3d a, Vec3d b, double reach) noexcept {
  const double whole = length(b - a);
  if (!(whole > 0)) return 0;
  const Vec3d axis = (b - a) / whole, u = any_perpendicular(axis), v = cross(axis, u);
  double angle = 0;
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    const Vec3d c = p[i] - a, d = p[i + 1] - a;
    const double at = dot(0.5 * (c + d), axis);
    if (at < 0 || at > whole) continue;
    const double cx = dot(c, u), cy = dot(c, v), dx = dot(d, u), dy = dot(d, v);
    if (cx * cx + cy * cy > reach * reach || dx * dx + dy * dy > reach * reach) continue;
    angle += portable::atan2(cx * dy - cy * dx, cx * dx + cy * dy);
  }
  return angle / (2 * portable::pi);
}

}  // namespace trocar::suture

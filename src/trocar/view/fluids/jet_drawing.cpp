#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/fluids/film_splats.hpp>
#include <trocar/view/fluids/jet_drawing.hpp>

namespace trocar::view {
namespace {

using render::Liquid;
using render::Splat;
using render::SplatKind;

// A wave that goes along with a column of liquid pinches it off into beads [Rayleigh 1878].
constexpr float kColumn = 1 / 1.89f;  // of a drop's radius: that of the column that makes it
constexpr float kGrowth = 0.34f;      // the fastest wave's rate, times sqrt(rho a^3 / sigma)
// Our choice, all of the rest: from the look of spurts in endoscopic films.
constexpr float kSoonest = 1.7f, kLatest = 4.2f;  // a neck closes after so many times of growth
constexpr float kSecondNeck = 0.25f;              // share of beads that tear in two ...
constexpr float kLater = 1.3f;                    // ... so many times of growth later
constexpr float kHangTogether = 0.6f;             // share of beads that never part from the next: ligaments
constexpr float kAnywhere = 0.40f;                // in beads: how far a neck is from the middle between two
constexpr float kJetBulge = 0.25f;                // in column radii: what necks lose, middles win
constexpr float kDrawsIn = 0.15f;                 // of its length: a bead that has detached becomes rounder
constexpr float kBall = 0.85f;                    // in column radii: such a bead's half width, before it is torn
constexpr float kJetTorn = 0.3f;                  // of that: what most lose to drops too small to show
constexpr int kMostRods = 14;                     // that a bead is drawn as
constexpr float kJetThinnest = 0.14f;             // in column radii: of threads that show
constexpr float kJetRagged = 0.32f;               // of a column's radius
constexpr float kPulse = 0.32f;                   // of a column's radius: it does not leave evenly
constexpr float kUsual = 1.5f;                    // [m/s] pressure that drives blood quicker widens its hole
constexpr float kSprayed = 0.45f;                 // share of a jet's radius that spray takes, far off
constexpr float kJetFar = 0.035f;                 // [m]
constexpr float kShutter = 4.0e-3f;               // [s] a camera's: what flies is a streak
constexpr float kGreen = 18e-6f;                  // [m] of blood lets 1/e of green light through, there and back
constexpr float kWag = 0.13f;                     // how far a jet strays aside, a share of its way ...
constexpr float kLongestWag = 0.045f;             // [m] ... up to here: drops land where the simulation says
constexpr float kWavers = 0.025f;                 // [m] ... of which it wavers as much as it will
constexpr float kBeadStrays = 0.08f;              // of a jet's speed
constexpr float kSprayStrays = 0.16f;
constexpr int kMostSpray = 4;                                  // drops from a neck
constexpr float kThinSpray = 0.05e-3f, kWideSpray = 0.25e-3f;  // [m] radius
constexpr float kFirstThread = 0.005f;                         // [m] a column goes so far before threads detach
constexpr float kThickThread = 0.34e-3f;                       // [m] radius
constexpr float kFan = 0.10f;                                  // how far threads are aside, a share of their way
constexpr int kMostThreads = 5;                                // from a drop of the simulation
constexpr float kRainDrop = 0.66e-3f;  // [m] radius: what has joined to larger drops is drawn as several
constexpr int kMostRain = 9;
constexpr float kRainShows = 0.45f;        // of their radius: the rest are drops too small to show
constexpr float kRainSpread = 4.0f;        // in radii of the large one
constexpr float kFootThick = 180e-6f;      // [m] of the pool it wells up from
constexpr float kThinnestFoot = 0.25e-3f;  // [m]
constexpr float kJetRoot = 0.4e-3f;        // [m] above its hole a jet begins: round, below it is the pit
constexpr float kFreshJet = 0.006f;        // [m] blood that has come less far shows where its hole is
constexpr float kLongestLink = 9.0f;       // in radii: drops hang together up to here
constexpr float kRod = 1.5f;               // in radii: about how long one is
constexpr float kJetStep = 1.1f;           // in radii: rods with such gaps, round ends left out, make one (splat.frag)

/// How far a jet's blood has come since it left its vessel [m]; 0 of other fluids, which do not know it and hang
/// together better.
float come(const fluids::DropletModel& m, const fluids::DropletState& d, std::int32_t i) {
  const auto k = std::size_t(i);
  const fluids::SmallMix& mix = d.volume[k];
  if (!(2 * std::int64_t(mix.blood) > mix.total())) return 0;
  const float age = std::max(now_of(m, d) - d.blood[k].born, 0.0f);
  // What goes up stops at the top of its way: what counts is how fast it was, too.
  const Vec3f first = speed(d, i) - age * vec_cast<float>(m.gravity);
  return 0.5f * age * (length(speed(d, i)) + length(first));
}

Vec3f beside(Vec3f along, float x, float y) {
  const Vec3f one = normalised(cross(along, std::fabs(along.x) < 0.7f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0}));
  return x * one + y * cross(along, one);
}

/// Where a drop of a jet is off the straight way, as a share of that: its hole wags slowly, and the jet wavers.
Vec3f wag(Vec3f along, std::uint32_t id, float way) {
  const float k = float(id % 65536), wavers = 0.6f * std::min(way / kWavers, 1.0f);
  return beside(along, kWag * (0.5f * std::sin(0.017f * k) + wavers * std::sin(0.33f * k + 1)),
                kWag * (0.5f * std::sin(0.013f * k + 2) + wavers * std::sin(0.27f * k)));
}

/// -1 .. 1: waves of unequal length that go along with the blood.
float pulse(std::uint32_t id) {
  const float k = float(id % 65536);
  return 0.5f * std::sin(0.71f * k) + 0.5f * std::sin(0.29f * k + 2);
}

/// Where a piece strays, as a share of its speed along `along`.
Vec3f strays(Vec3f along, std::uint32_t id, int which) {
  return beside(along, own(id, which), own(id, which + 1)) + (0.6f * own(id, which + 2)) * along;
}

/// A drop of the simulation as a part of a strand, as drawn.
struct Node {
  Vec3f place, velocity;  ///< [m], [m/s]
  float volume = 0;       ///< [m^3]
  float radius = 0;       ///< of its column [m]
  float way = 0;          ///< since it left its vessel [m]; 0 = not known
  float grown = 0;        ///< how many times a wave on it has grown by e
  float grows = 1;        ///< [s] in which it does
  std::uint32_t id = 0;
  std::array<float, 3> share{};
  float dark = 0;
};

Node node_of(const fluids::DropletModel& m, const fluids::DropletState& d, std::int32_t i) {
  const auto k = std::size_t(i);
  Node n;
  n.id = d.id[k], n.way = come(m, d, i), n.velocity = speed(d, i), n.place = at(d, i);
  const float fast = length(n.velocity), r = d.radius[k];
  const Vec3f off = wag(normalised(n.velocity, Vec3f{0, 0, 1}), n.id, n.way);
  n.place += std::min(n.way, kLongestWag) * off;
  if (n.way > 0 && n.way < kLongestWag) n.velocity += fast * off;
  n.volume = 4.18879f * r * r * r;
  n.radius = kColumn * r;
  n.share = shares_of(d.volume[k]);
  n.dark = darkness(now_of(m, d), d.blood[k], n.share);
  n.grows = std::sqrt(float(m.density.blood / m.surface_tension) * n.radius * n.radius * n.radius) / kGrowth;
  if (n.way > 0) n.grown = (now_of(m, d) - d.blood[k].born) / n.grows;
  return n;
}

/// Where a strand is thinnest.
struct Neck {
  float at = 0;     ///< along the strand: 0 at its youngest drop, 1 at the next
  float since = 0;  ///< it closed, in times of growth; negative: until it will
  std::uint32_t id = 0;
  /// 0 not to be seen .. 1 closed
  float deep() const { return std::exp(std::min(since, 0.0f)); }
};

/// Drops that left an opening one after the other, the youngest first: a column that becomes beads and spray.
class Strand {
 public:
  /// @param nodes  two or more
  explicit Strand(std::vector<Node> nodes);
  void list(Liquid& liquid) const;

 private:
  Vec3f corner(int i) const;
  Vec3f at(float u) const;
  const Node& node(float u) const {
    return m_nodes[std::size_t(std::clamp(int(std::lround(u)), 0, int(m_nodes.size()) - 1))];
  }
  float radius(float u) const;
  void even_out();
  void find_necks();
  void list_bead(const Neck& a, const Neck& b, Liquid& liquid) const;
  void list_spray(const Neck& neck, Liquid& liquid) const;
  void list_threads(const Node& n, Liquid& liquid) const;

  std::vector<Node> m_nodes;
  std::vector<Neck> m_necks;
};

Strand::Strand(std::vector<Node> nodes) : m_nodes(std::move(nodes)) {
  even_out();
  find_necks();
}

/// The column's radius from what there is of it between the neighbours: drops leave in whole ticks, it does not.
void Strand::even_out() {
  const int count = int(m_nodes.size());
  std::vector<float> radius(m_nodes.size());
  for (int i = 0; i < count; ++i) {
    const int first = std::max(i - 2, 0), last = std::min(i + 2, count - 1);
    float volume = 0;
    for (int k = first; k <= last; ++k)
      volume += (k == first || k == last ? 0.5f : 1.0f) * m_nodes[std::size_t(k)].volume;
    const float far = length(m_nodes[std::size_t(last)].place - m_nodes[std::size_t(first)].place);
    radius[std::size_t(i)] = std::sqrt(volume / (float(portable::pi) * std::max(far, 1e-5f)));
  }
  for (int i = 0; i < count; ++i) {
    Node& n = m_nodes[std::size_t(i)];
    const float most = n.radius / kColumn;
    n.radius = std::min(radius[std::size_t(i)], most);
    if (n.way > 0) {
      n.radius *= std::clamp(length(n.velocity) / kUsual, 0.8f, 1.2f);
      n.radius *= 1 + kPulse * pulse(n.id) * std::min(n.way / kWavers, 1.0f);
      n.radius *= 1 - kSprayed * float(smooth(0, double(kJetFar), double(n.way)));
    } else {
      // Other fluids: as far as it is drawn out.
      n.grown = 3.5f + 4 * std::min(kColumn - n.radius / most, 0.0f);
    }
  }
}

void Strand::find_necks() {
  const auto end = [this](float u, int which) {
    const Node& n = node(u);
    return Neck{u, 3 * float(varied(int(n.id & 0xffffff), which)), n.id};
  };
  const Node& youngest = m_nodes.front();
  const float step = length(corner(1) - corner(0));
  if (youngest.way > 0 && youngest.way < kFreshJet)
    m_necks.push_back({-(youngest.way - kJetRoot) / step, -youngest.grown - 9, youngest.id});
  else
    m_necks.push_back(end(-0.5f, 41));
  for (std::size_t k = 0; k < m_nodes.size(); ++k) {
    const Node& n = m_nodes[k];
    const auto mine = [&n](int which) { return float(varied(int(n.id & 0xffffff), which)); };
    const float closes = kSoonest + (kLatest - kSoonest) * mine(43);
    if (mine(44) < kSecondNeck && n.way > 0)
      m_necks.push_back({float(k) + 0.2f * own(n.id, 45), n.grown - closes - kLater, n.id + 0x10000});
    if (k + 1 < m_nodes.size() && !(mine(47) < kHangTogether && n.way > 0))
      m_necks.push_back({float(k) + 0.5f + kAnywhere * own(n.id, 46), n.grown - closes, n.id});
  }
  m_necks.push_back(end(float(m_nodes.size()) - 0.5f, 42));
}

/// Of the polygon that the strand smooths; continues straight beyond the ends.
Vec3f Strand::corner(int i) const {
  const int last = int(m_nodes.size()) - 1;
  const int from = i < 0 ? 0 : last, other = i < 0 ? 1 : last - 1;
  if (i >= 0 && i <= last) return m_nodes[std::size_t(i)].place;
  const Vec3f end = m_nodes[std::size_t(from)].place, step = end - m_nodes[std::size_t(other)].place;
  return end + std::fabs(float(i - from)) * step;
}

/// A cubic B-spline: no kinks, no loops.
Vec3f Strand::at(float u) const {
  const float whole = std::floor(u), t = u - whole, o = 1 - t;
  const int i = int(whole);
  return (1.0f / 6) * ((o * o * o) * corner(i - 1) + (3 * t * t * t - 6 * t * t + 4) * corner(i) +
                       (3 * o * o * o - 6 * o * o + 4) * corner(i + 1) + (t * t * t) * corner(i + 2));
}

float Strand::radius(float u) const {
  const float whole = std::floor(u), t = u - whole;
  return (1 - t) * node(whole).radius + t * node(whole + 1).radius;
}

/// Half as much liquid as hides what is behind it for so large a part of the time, at most as much as there is [m].
float covering(float share, float most) {
  return std::min(-kGreen * std::log(1 - std::clamp(share, 0.0f, 0.999f)), most);
}

/// What is smeared over the time the shutter is open: it covers what is behind it for a part of that.
Splat streak(const Node& n, Vec3f place, Vec3f velocity, float radius, float length_of_it) {
  Splat s;
  s.kind = SplatKind::streak;
  const float smeared = kShutter * length(velocity), all = length_of_it + smeared;
  const Vec3f half = (0.5f * all) * normalised(velocity, Vec3f{0, 0, 1});
  s.from = place - half, s.to = place + half;
  s.radius = radius;
  s.height = covering((length_of_it + 2 * radius) / (all + 2 * radius), radius);
  s.share = n.share, s.dark = n.dark;
  return s;
}

/// What is between two necks.
void Strand::list_bead(const Neck& a, const Neck& b, Liquid& liquid) const {
  const float middle = 0.5f * (a.at + b.at), half = 0.5f * (b.at - a.at);
  if (!(half > 0)) return;
  const Node& n = node(middle);
  const float free = std::max(std::min(a.since, b.since), 0.0f), round = 1 - std::exp(-free), in = kDrawsIn * round;
  const Vec3f along = normalised(n.velocity, Vec3f{0, 0, 1});
  const Vec3f off = (free * n.grows * length(n.velocity) * kBeadStrays) * strays(along, b.id, 51);
  const float thick = radius(middle), whole = (1 - in) * length(at(b.at) - at(a.at));
  const float smeared = n.way > 0 ? std::min(free, 1.0f) * kShutter * length(n.velocity) : 0.0f, all = whole + smeared;
  const int count = std::clamp(int(std::ceil(all / (kRod * thick))), 1, kMostRods);
  const float mean = 0.5f * (a.deep() + b.deep()),
              kept = (1 - kJetTorn * (1 + own(b.id, 55)) * round) / std::sqrt(1 - in);
  for (int j = 0; j < count; ++j) {
    const float w = (2 * float(j) + 1) / float(count) - 1, deep = w < 0 ? a.deep() : b.deep();
    const float pinch = 0.5f - 0.5f * std::cos(float(portable::pi) * w);
    const float wave = 1 + kJetBulge * mean * (1 - pinch) - deep * pinch, ball = kBall * std::sqrt(1 - w * w);
    const float profile = (1 - round) * wave + round * ball;
    if (profile < kJetThinnest) continue;
    Splat s;
    s.radius = thick * kept * profile * (1 + kJetRagged * std::min(n.grown / 3, 1.0f) * own(b.id, 60 + j));
    s.height = s.radius;
    // The shutter smears it: what is behind it shows through for a part of the time.
    if (smeared > 0) s.height = covering(0.5f * all * (1 - std::fabs(w)) / std::min(smeared, whole), s.radius);
    const float u = middle + half * w * all / length(at(b.at) - at(a.at));
    const Vec3f tangent = normalised(at(u + 0.1f) - at(u - 0.1f), along), p = at(u) + off;
    const Vec3f rod = (0.5f * std::max(all / float(count) - kJetStep * s.radius, 0.0f)) * tangent;
    s.from = p - rod, s.to = p + rod;
    s.share = n.share, s.dark = n.dark;
    liquid.splats.push_back(s);
  }
}

/// Where a neck tears, small drops detach.
void Strand::list_spray(const Neck& neck, Liquid& liquid) const {
  const Node& n = node(neck.at);
  if (!(neck.since > 0) || !(n.way > 0)) return;
  const Vec3f along = normalised(n.velocity, Vec3f{0, 0, 1});
  const int count = int(float(varied(int(neck.id & 0xffffff), 71)) * float(kMostSpray + 1));
  for (int k = 0; k < count; ++k) {
    const float size = float(varied(int(neck.id & 0xffffff), 80 + k));
    const float r = kThinSpray + (kWideSpray - kThinSpray) * size * size;
    const Vec3f stray = (kSprayStrays * length(n.velocity)) * strays(along, neck.id, 90 + 3 * k);
    Splat s = streak(n, at(neck.at) + (neck.since * n.grows) * stray, n.velocity + stray, r, r);
    s.height *= 4 * std::min(neck.since, 1.0f);
    liquid.splats.push_back(s);
  }
}

/// What the air tears off a column's sides: thin threads along the flight, more and further out on the way.
void Strand::list_threads(const Node& n, Liquid& liquid) const {
  const double torn = smooth(double(kFirstThread), double(kJetFar), double(n.way));
  const int count = int(float(kMostThreads) * float(torn) + float(varied(int(n.id & 0xffffff), 160)));
  const Vec3f along = normalised(n.velocity, Vec3f{0, 0, 1});
  for (int k = 0; k < count && torn > 0; ++k) {
    const float size = float(varied(int(n.id & 0xffffff), 170 + k));
    const float r = kThinSpray + (kThickThread - kThinSpray) * size * size;
    const Vec3f side = strays(along, n.id, 180 + 4 * k);
    const float out = 0.9f * n.radius + kFan * std::min(n.way, kLongestWag) * (1 - 0.7f * size);
    liquid.splats.push_back(
        streak(n, n.place + out * side, n.velocity + (kFan * length(n.velocity)) * side, r, 14 * r));
  }
}

void Strand::list(Liquid& liquid) const {
  for (const Node& n : m_nodes)
    if (n.way > 0) list_threads(n, liquid);
  for (std::size_t k = 0; k + 1 < m_necks.size(); ++k) list_bead(m_necks[k], m_necks[k + 1], liquid);
  for (std::size_t k = 1; k + 1 < m_necks.size(); ++k) list_spray(m_necks[k], liquid);
}

/// A jet wells up out of a small pool around its hole, deepest there, drawn out down the tissue.
void list_foot(const Node& n, const FilmPlace& hole, Vec3f down, Liquid& liquid) {
  const Vec3f fall = down - dot(down, hole.normal) * hole.normal;
  const float wide = std::max(n.radius, kThinnestFoot);
  constexpr float kPatches[][2] = {{0, 2.4f}, {2.2f, 2.0f}, {4.4f, 1.5f}};  // in column radii: lower; radius
  for (const auto& [lower, radius] : kPatches) {
    Splat s;
    s.kind = SplatKind::film;
    s.from = s.to = hole.position + (lower * wide) * fall;
    s.from -= (0.8f * wide) * fall;
    s.normal = hole.normal;
    s.radius = radius * wide, s.height = kFootThick / (1 + 0.5f * lower);
    s.share = n.share, s.dark = n.dark;
    liquid.splats.push_back(s);
  }
}

/// A drop on its own; what has joined to a large one is several, some of them small.
void list_rain(const Node& n, Liquid& liquid) {
  const float r = n.radius / kColumn;
  const int count = n.way > 0 ? std::clamp(int(std::pow(r / kRainDrop, 3.0f)), 1, kMostRain) : 1;
  const Vec3f along = normalised(n.velocity, Vec3f{0, 0, 1});
  const float mean = count == 1 ? r : kRainShows * r / std::cbrt(float(count));
  for (int k = 0; k < count; ++k) {
    const float size = count == 1 ? mean : mean * (1 + 0.6f * own(n.id, 100 + k));
    const Vec3f off = count == 1 ? Vec3f{} : strays(along, n.id, 120 + 3 * k) + own(n.id, 140 + k) * along;
    liquid.splats.push_back(streak(n, n.place + (kRainSpread * r) * off, n.velocity, size, size));
  }
}

}  // namespace

void JetDrawing::gather(const fluids::DropletState& d) {
  m_flying.clear();
  for (std::int32_t i = 0; i < d.count; ++i) {
    const auto k = std::size_t(i);
    if (d.body[k] >= 0 || !(d.radius[k] > 0) || !finite(at(d, i)) || !finite(speed(d, i))) continue;
    m_flying.push_back({d.id[k], i, false});
  }
  std::sort(m_flying.begin(), m_flying.end(), [](const Flying& a, const Flying& b) { return a.id > b.id; });
}

/// The drop that left the same opening just before it and still hangs together with it, or the end.
std::size_t JetDrawing::next_in_strand(const fluids::DropletState& d, std::size_t n) const {
  const std::int32_t i = m_flying[n].at;
  const float r = d.radius[std::size_t(i)];
  for (std::size_t m = n + 1; m < std::min(n + 9, m_flying.size()); ++m) {
    const std::int32_t j = m_flying[m].at;
    const float other = d.radius[std::size_t(j)], size = std::max(r, other);
    const Vec3f way = at(d, j) - at(d, i), difference = speed(d, j) - speed(d, i);
    const float far = length(way), fast = length(speed(d, i));
    if (m_flying[m].in_strand || far > kLongestLink * size || far < 0.2f * size || std::min(r, other) < 0.35f * size)
      continue;
    if (length(difference) > 0.25f * fast + 0.1f) continue;
    if (std::fabs(dot(way, speed(d, i))) < 0.75f * far * fast) continue;  // side by side
    return m;
  }
  return m_flying.size();
}

void JetDrawing::list(const FluidSight& sight, Vec3f eye, Liquid& liquid) {
  const fluids::DropletState& d = sight.state.droplets;
  gather(d);
  for (std::size_t first = 0; first < m_flying.size(); ++first) {
    if (m_flying[first].in_strand) continue;
    std::vector<Node> nodes;
    for (std::size_t n = first; n < m_flying.size(); n = next_in_strand(d, n)) {
      nodes.push_back(node_of(m_model->droplets, d, m_flying[n].at));
      m_flying[n].in_strand = true;
    }
    if (nodes.size() > 1) {
      Strand(std::move(nodes)).list(liquid);
    } else {
      list_rain(nodes[0], liquid);
      m_flying[first].in_strand = false;
    }
  }
  list_holes(sight, eye, liquid);
}

/// A hole is where the youngest blood of a jet comes from.
void JetDrawing::list_holes(const FluidSight& sight, Vec3f eye, Liquid& liquid) const {
  const fluids::DropletState& d = sight.state.droplets;
  const float now = now_of(m_model->droplets, d);
  std::vector<Vec3f> known;
  for (const Flying& drop : m_flying) {
    const auto k = std::size_t(drop.at);
    const float way = come(m_model->droplets, d, drop.at);
    if (!drop.in_strand || way > kFreshJet || !(way > 0)) continue;
    const Vec3f hole = at(d, drop.at) - way * normalised(speed(d, drop.at), Vec3f{0, 0, 1});
    const auto near = [hole](Vec3f other) { return length(other - hole) < 0.004f; };
    if (std::any_of(known.begin(), known.end(), near)) continue;
    known.push_back(hole);
    const FilmPlace facing{hole, normalised(eye - hole, Vec3f{0, 0, 1})};
    Wound wound;
    wound.down = liquid.down;
    wound.share = shares_of(d.volume[k]);
    wound.dark = darkness(now, d.blood[k], wound.share);
    const FilmPlace place = sight.surface ? sight.surface(facing) : facing;
    list_wound(wound, place, sight.surface, liquid);
    list_foot(node_of(m_model->droplets, d, drop.at), place, liquid.down, liquid);
  }
}

}  // namespace trocar::view

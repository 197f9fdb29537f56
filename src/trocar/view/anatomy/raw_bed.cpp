#include <algorithm>
#include <cmath>
#include <map>

#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/view/anatomy/raw_bed.hpp>

namespace trocar::view {
namespace {

constexpr std::uint32_t kBedParts = 4;                 // of an edge of the organ's skin
constexpr float kBedReach = 0.0072f;                   // [m] of a bond
constexpr float kBedAround = 0.0078f;                  // [m] so far from bonds there are vertices
constexpr double kBareFrom = 0.22, kBareTo = 0.85;     // of the sum of bonds' bells: the capsule is there, and gone
constexpr double kStillHeld = 0.5;                     // what a bond that holds takes off that
constexpr double kTucked = 0.0006;                     // [m] below the skin, where there is none
constexpr float kHidden = -0.0001f;                    // [m] ... and at least so much where no part of it shows
constexpr double kBedHigh = 0.00015;                   // [m] above it, where it is bare ...
constexpr double kCrustHigh = 0.00040;                 // [m] ... and more, where eschar is thickest
constexpr double kGranular = 0.00013;                  // [m] how uneven it is
constexpr int kOozingSpots = 3;                        // of a bond
constexpr float kScattered = 0.0036f;                  // [m] around its foot
constexpr double kTanned = 0.70, kCharred = 0.30;      // of Paint::burn: a crust, and more where it is black
constexpr double kBlanchedRim = 0.10, kPalest = 0.16;  // of Paint::burn: around it
constexpr double kMoist = 0.18, kRawMoist = 0.28, kRimMoist = 1.0;  // of Paint::blood: on a crust, and between

/// 1 in the middle, 0 from `reach` on.
float bell(Vec3f off, float reach) {
  const float inside = 1 - dot(off, off) / (reach * reach);
  return inside <= 0 ? 0 : inside * inside;
}

/// Bends patterns, so that they are no waves.
Vec3d warp(Vec3d p) {
  const auto way = [&](double x, double size) { return waves(p + Vec3d{x, 2 * x, -x}, size); };
  return 0.0016 * Vec3d{way(0.2, 0.007), way(0.4, 0.007), way(0.6, 0.007)} +
         0.0006 * Vec3d{way(0.3, 0.0026), way(0.5, 0.0026), way(0.7, 0.0026)};
}

/// Is this a bond of a wall with that organ?
bool ties(const sim::Model& model, const interactions::BondSet& set, const interactions::Bond& bond,
          std::size_t solid) {
  return set.of_membrane() && bond.vertex >= 0 &&
         sim::lattice_of(model, int(bond.far.body.index())) == std::int32_t(solid);
}

}  // namespace

bool RawBed::lies_on(const sim::Model& model, std::size_t solid) {
  for (const interactions::BondSet& set : model.bonds)
    for (const interactions::Bond& bond : set.bonds)
      if (ties(model, set, bond, solid)) return true;
  return false;
}

RawBed::RawBed(const sim::Model& model, std::size_t solid, const OrganDrawing& organ, render::Backend& backend)
    : m_solid(solid) {
  find_feet(model);
  divide(model, organ);
  m_seen.assign(m_feet.size(), Seen::holds);
  place(organ);
  m_buffer.rest = m_buffer.positions;
  m_all = m_buffer.indices;
  m_mesh = OwnedMesh(backend, m_buffer.data());
}

void RawBed::find_feet(const sim::Model& model) {
  for (std::size_t s = 0; s < model.bonds.size(); ++s)
    for (std::size_t b = 0; b < model.bonds[s].bonds.size(); ++b) {
      const interactions::Bond& bond = model.bonds[s].bonds[b];
      if (!ties(model, model.bonds[s], bond, m_solid)) continue;
      const tissue::Skin& skin = model.skin(int(bond.far.body.index()));
      const int number = 40 * int(m_feet.size());
      Foot foot{s, b, skin.rest[std::size_t(bond.vertex)], float(varied(number, 9)), {}};
      const auto normal = vec_cast<double>(skin.rest_normal[std::size_t(bond.vertex)]);
      const Vec3d u = any_perpendicular(normal), v = cross(normal, u);
      for (int k = 0; k < kOozingSpots; ++k) {
        const auto any = [&](int what) { return varied(number + k, what); };
        const Vec3d aside = double(kScattered) * ((2 * any(1) - 1) * u + (2 * any(2) - 1) * v);
        foot.oozing.push_back(
            {foot.at + vec_cast<float>(aside), float(0.0008 + 0.0012 * any(3) * any(5)), float(0.3 + 0.7 * any(4))});
      }
      m_feet.push_back(std::move(foot));
    }
}

/// The organ's triangles around, in small ones; neighbours share the vertices on their common edge.
void RawBed::divide(const sim::Model& model, const OrganDrawing& organ) {
  const tissue::Skin& skin = model.solids[m_solid].fine;
  const auto near = [&](Vec3f p, float reach) {
    std::vector<std::uint16_t> feet;
    for (std::size_t f = 0; f < m_feet.size(); ++f)
      if (const Vec3f off = p - m_feet[f].at; dot(off, off) < reach * reach) feet.push_back(std::uint16_t(f));
    return feet;
  };
  std::map<std::array<std::uint32_t, 6>, std::uint32_t> known;  // corners by rising number, and their parts
  const auto vertex = [&](const std::array<int, 3>& t, std::uint32_t i, std::uint32_t j) {
    const std::uint32_t part[3] = {kBedParts - i - j, i, j};
    std::array<std::pair<std::uint32_t, std::uint32_t>, 3> order{};
    for (std::size_t k = 0; k < 3; ++k) order[k] = {part[k] == 0 ? ~0u : std::uint32_t(t[k]), part[k]};
    std::sort(order.begin(), order.end());
    std::array<std::uint32_t, 6> key{};
    for (std::size_t k = 0; k < 3; ++k) key[k] = order[k].first, key[k + 3] = order[k].second;
    const auto [at, fresh] = known.insert({key, m_buffer.size()});
    if (fresh) {
      Place p;
      Vec3f rest{0, 0, 0};
      for (std::size_t k = 0; k < 3; ++k) {
        p.corner[k] = std::uint32_t(t[k]);
        p.share[int(k)] = float(part[k]) / float(kBedParts);
        rest += p.share[int(k)] * skin.rest[p.corner[k]];
      }
      p.near = near(rest, kBedAround);
      p.high = float(-kTucked);
      m_places.push_back(std::move(p));
      m_buffer.add(rest, organ.paint()[std::size_t(t[0])]);
    }
    return at->second;
  };
  for (const std::array<int, 3>& t : skin.triangles) {
    bool around = false;
    for (const int v : t) around = around || !near(skin.rest[std::size_t(v)], kBedAround).empty();
    if (!around) continue;
    for (std::uint32_t j = 0; j < kBedParts; ++j)
      for (std::uint32_t i = 0; i + j < kBedParts; ++i) {
        m_buffer.triangle(vertex(t, i, j), vertex(t, i + 1, j), vertex(t, i, j + 1));
        if (i + j + 1 < kBedParts) m_buffer.triangle(vertex(t, i + 1, j), vertex(t, i + 1, j + 1), vertex(t, i, j + 1));
      }
  }
}

/// What has become of the bonds, and of the tissue below. @return has anything?
bool RawBed::look_at(const sim::State& state, const OrganDrawing& organ) {
  bool changed = false;
  m_any = false;
  for (std::size_t f = 0; f < m_feet.size(); ++f) {
    const interactions::BondState& bond = state.bonds[m_feet[f].set][m_feet[f].bond];
    const Seen seen = bond.holds() ? Seen::holds : bond.raw() ? Seen::raw : Seen::burnt;
    changed = changed || seen != m_seen[f];
    m_seen[f] = seen;
    m_any = m_any || seen != Seen::holds;
  }
  std::uint64_t burns = 0;
  for (const Place& p : m_places) burns += organ.paint()[p.corner[0]].burn;
  changed = changed || burns != m_burns;
  m_burns = burns;
  return changed;
}

void RawBed::paint(std::size_t vertex, const OrganDrawing& organ) {
  Place& at = m_places[vertex];
  const Vec3f rest = m_buffer.rest[vertex];
  const auto p = vec_cast<double>(rest);
  const Vec3d q = p + warp(p);
  double parted = 0, burnt = 0, held = 0, strength = 0, oozing = 0;
  for (const std::uint16_t f : at.near) {
    const Foot& foot = m_feet[f];
    const auto w = double(bell(rest - foot.at, kBedReach));
    (m_seen[f] == Seen::holds ? held : parted) += w;
    if (m_seen[f] == Seen::burnt) burnt += w, strength += w * double(foot.strength);
    for (const Spot& s : foot.oozing)
      if (m_seen[f] != Seen::holds)
        oozing = std::max(oozing, double(s.strength * bell(vec_cast<float>(q) - s.at, s.radius)));
  }
  const double uneven = smooth(0, 0.4, parted) * (0.26 * waves(q, 0.0083) + 0.15 * waves(q, 0.0034));
  const double torn = parted - kStillHeld * held + uneven;
  const double bare = smooth(kBareFrom, kBareTo, torn), inner = smooth(0.8, 1, bare), deep = smooth(0.5, 1.5, torn);
  const double dry = parted > 0 ? burnt / parted : 0;
  // How far current has gone: unevenly, from bond to bond, in streaks and in specks.
  const double gone = 0.20 + 0.26 * deep + (burnt > 0 ? 0.5 * (strength / burnt - 0.5) : 0) + 0.28 * waves(q, 0.0125) +
                      0.30 * waves(q, 0.0058) + 0.13 * waves(q, 0.0026) + 0.05 * waves(q, 0.0012);
  const double tan = smooth(0.26, 0.44, gone), charred = smooth(0.38, 0.92, gone);
  double below = 0, open = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto share = double(at.share[int(k)]);
    below += share * organ.paint()[at.corner[k]].burn / 255;
    open += share * organ.paint()[at.corner[k]].openness / 255;
  }
  const double moist = kMoist + (kRawMoist - kMoist) * smooth(0.54, 0.30, gone);
  const double wet = (1 - dry) * (0.37 + 0.12 * waves(q, 0.004)) +
                     dry * (moist + kRimMoist * std::max(inner * (1 - inner), tan * (1 - tan))) +
                     0.8 * oozing * (1 - charred);
  const double grains = waves(q, 0.0023) + waves(q, 0.0047);
  const double crust = dry * (0.35 * tan + 0.65 * charred) * (0.75 + 0.35 * waves(q, 0.0015));
  at.high = float((kBedHigh + kTucked + kGranular * grains + kCrustHigh * crust) * bare - kTucked);
  Paint& paint = m_buffer.paint[vertex];
  paint.openness = to_byte(open);
  paint.blood = to_byte(std::clamp(wet, 0.0, 0.85) * smooth(0.78, 0.95, bare));
  const double blanched = kBlanchedRim * dry * smooth(0.68, 0.8, bare);
  const double burn =
      dry * (kTanned * tan + kCharred * charred) * inner + (1 - inner) * std::min(std::max(below, blanched), kPalest);
  paint.burn = to_byte(burn);
  paint.tint = to_byte(0.8 * inner * smooth(0.05, 0.6, waves(q + Vec3d{0.1, 0, 0}, 0.0068)));  // fascia
}

/// Where the capsule is whole it lies below the skin: many small triangles that nobody sees.
void RawBed::leave_out_hidden() {
  m_buffer.indices.clear();
  const auto high = [&](std::size_t i) { return m_places[m_all[i]].high > kHidden; };
  for (std::size_t t = 0; t < m_all.size(); t += 3)
    if (high(t) || high(t + 1) || high(t + 2)) m_buffer.triangle(m_all[t], m_all[t + 1], m_all[t + 2]);
  if (m_buffer.indices.empty()) m_buffer.triangle(m_all[0], m_all[1], m_all[2]);  // a mesh has at least one
}

void RawBed::place(const OrganDrawing& organ) {
  for (std::size_t v = 0; v < m_places.size(); ++v) {
    const Place& at = m_places[v];
    Vec3f p{0, 0, 0}, out{0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      p += at.share[int(k)] * organ.positions()[at.corner[k]];
      out += at.share[int(k)] * organ.normals()[at.corner[k]];
    }
    m_buffer.positions[v] = p + at.high * normalised(out, Vec3f{0, 0, 1});
  }
  render::vertex_normals(m_buffer.positions, m_buffer.indices, m_buffer.normals);
}

void RawBed::update(const sim::State& state, const OrganDrawing& organ) {
  const bool changed = look_at(state, organ);
  if (!m_any || (!changed && organ.version() == m_version)) return;
  m_version = organ.version();
  for (std::size_t v = 0; changed && v < m_places.size(); ++v) paint(v, organ);
  if (changed) leave_out_hidden();
  place(organ);
  if (changed)
    m_mesh.replace(m_buffer.data());
  else
    m_mesh.move(m_buffer.positions, m_buffer.normals);
}

}  // namespace trocar::view

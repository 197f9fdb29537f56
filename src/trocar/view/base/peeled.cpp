#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/base/peeled.hpp>
#include <trocar/view/base/relief.hpp>

namespace trocar::view {
namespace {

constexpr float kRootReaches = 0.0068f;               // [m] on the wall
constexpr double kRawFrom = 0.30, kRawTo = 1.0;       // of the sum of bells
constexpr double kHoldsBack = 0.5;                    // what a root that holds takes off that
constexpr double kRimHigh = 0.0004, kRimPale = 0.22;  // [m], and of Paint::burn
constexpr double kRawBlood = 0.36, kDryBlood = 0.25;  // of Paint::blood
constexpr double kSpecks = 0.66;                      // of Paint::burn

}  // namespace

Peeled::Peeled(const sim::Model& model, int membrane, std::span<const Vec3d> places) : m_marks(places.size()) {
  for (const Vec3d& p : places) m_places.push_back(vec_cast<float>(p));
  const std::vector<Vec3d>& rest = model.membranes[std::size_t(membrane)].sheet.network.rest;
  for (std::size_t s = 0; s < model.bonds.size(); ++s)
    for (std::size_t b = 0;
         b < model.bonds[s].bonds.size() && model.bonds[s].of == BodyId::maybe(BodyKind::membrane, membrane); ++b)
      m_roots.push_back({s, b, vec_cast<float>(rest[std::size_t(model.bonds[s].bonds[b].node())])});
  m_seen.assign(m_roots.size(), -1);
  for (const Vec3f& p : m_places) {
    m_near.emplace_back();
    for (std::size_t r = 0; r < m_roots.size(); ++r)
      if (const Vec3f off = p - m_roots[r].at; dot(off, off) < kRootReaches * kRootReaches)
        m_near.back().push_back(std::uint16_t(r));
  }
}

bool Peeled::update(const sim::State& state) {
  bool changed = false;
  for (std::size_t r = 0; r < m_roots.size(); ++r) {
    const interactions::BondState& bond = state.bonds[m_roots[r].set][m_roots[r].bond];
    const std::int32_t seen = bond.holds() ? -1 : bond.cause;
    changed = changed || seen != m_seen[r];
    m_seen[r] = seen;
  }
  for (std::size_t i = 0; changed && i < m_places.size(); ++i)
    if (!m_near[i].empty()) m_marks[i] = mark(i, state);
  return changed;
}

Peeled::Mark Peeled::mark(std::size_t vertex, const sim::State& state) const {
  const auto p = vec_cast<double>(m_places[vertex]);
  double parted = 0, held = 0, dry = 0;
  for (const std::uint16_t r : m_near[vertex]) {
    const Vec3f off = m_places[vertex] - m_roots[r].at;
    const double inside = 1 - double(dot(off, off)) / double(kRootReaches * kRootReaches), w = inside * inside;
    const interactions::BondState& bond = state.bonds[m_roots[r].set][m_roots[r].bond];
    (bond.holds() ? held : parted) += w;
    if (!bond.holds() && !bond.raw()) dry += w;
  }
  const double ragged = smooth(0, 0.4, parted) * (0.16 * waves(p, 0.009) + 0.12 * waves(p, 0.004));
  const double torn = parted - kHoldsBack * held + ragged;
  const double raw = smooth(kRawFrom, kRawTo, torn), share = parted > 0 ? dry / parted : 0;
  const double rim = smooth(0.12, 0.32, torn) * smooth(0.6, 0.4, torn);
  const double gone = 0.36 + 0.3 * waves(p, 0.0078) + 0.22 * waves(p, 0.0034);
  const double blood =
      (kRawBlood + (kDryBlood - kRawBlood) * share) * (1 + 0.45 * waves(p, 0.0065) + 0.3 * waves(p, 0.0034));
  return {to_byte(raw * blood), to_byte(std::max(kRimPale * rim, share * raw * kSpecks * smooth(0.44, 0.66, gone))),
          float(kRimHigh * rim)};
}

}  // namespace trocar::view

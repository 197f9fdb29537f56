// Compiling a strand: section properties, and the rest shape that makes the drawn one its equilibrium.
#include <cmath>
#include <stdexcept>
#include <string>

#include <trocar/numerics/banded.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/tissue/strand/strand.hpp>
#include <trocar/tissue/strand/strand_band.hpp>

namespace trocar::tissue {
namespace {

[[noreturn]] void refuse_strand(const std::string& what) { throw std::invalid_argument("strand: expected " + what); }

void check(const StrandDescription& d, double tick) {
  const std::size_t n = d.positions.size();
  if (n < 3) refuse_strand("at least 3 nodes, got " + std::to_string(n));
  if (!(tick > 0)) refuse_strand("tick > 0 s");
  if (d.radius.size() != n - 1) refuse_strand("one radius per element");
  if (!d.lumen.empty() && d.lumen.size() != n - 1) refuse_strand("no lumen, or one per element");
  if (!d.added_mass.empty() && d.added_mass.size() != n) refuse_strand("no added mass, or one per node");
  if (!d.foundation.empty() && d.foundation.size() != n) refuse_strand("no foundation, or one stiffness per node");
  if (!d.prescribed.empty() && d.prescribed.size() != n) refuse_strand("no prescribed flags, or one per node");
  if (!(d.youngs_modulus > 0 && d.density > 0)) refuse_strand("youngs_modulus > 0 and density > 0");
  if (!d.law.monotone()) refuse_strand("a law whose force grows with strain (P1^2 < 3 P2)");
  if (!(d.damping_time >= 0 && d.foundation_damping_time >= 0 && d.global_damping >= 0 &&
        d.foundation_stiffening >= 0 && d.lumen_density >= 0))
    refuse_strand("damping, stiffening and densities >= 0");
  for (std::size_t e = 0; e + 1 < n; ++e) {
    const double inner = d.lumen.empty() ? 0 : d.lumen[e];
    if (!(d.radius[e] > 0 && inner >= 0 && inner < d.radius[e]))
      refuse_strand("0 <= lumen < radius at element " + std::to_string(e));
    if (!(length(d.positions[e + 1] - d.positions[e]) > 1e-9))
      refuse_strand("different positions at the ends of element " + std::to_string(e));
  }
  for (std::size_t i = 0; i < d.foundation.size(); ++i)
    if (!(d.foundation[i] >= 0)) refuse_strand("foundation >= 0 at node " + std::to_string(i));
}

bool held(const StrandDescription& d, int node) {
  return !d.prescribed.empty() && d.prescribed[std::size_t(node)] != 0;
}

void fill_sections(StrandModel& m, const StrandDescription& d) {
  const double pi = portable::pi, modulus = d.youngs_modulus;
  std::vector<double> bend_element;
  m.mass = d.added_mass.empty() ? std::vector<double>(m.nodes, 0.0) : d.added_mass;
  for (int e = 0; e + 1 < m.nodes; ++e) {
    const double outer2 = d.radius[e] * d.radius[e], inner2 = m.lumen[e] * m.lumen[e];
    const double l = length(d.positions[e + 1] - d.positions[e]);
    m.rest_length.push_back(l);
    m.stretch.push_back(modulus * pi * (outer2 - inner2));
    bend_element.push_back(modulus * pi / 4 * (outer2 * outer2 - inner2 * inner2));
    const double half = 0.5 * l * pi * ((outer2 - inner2) * d.density + inner2 * d.lumen_density);
    m.mass[e] += half, m.mass[e + 1] += half;
  }
  m.bend.assign(m.nodes, 0.0);
  for (int i = 1; i + 1 < m.nodes; ++i) {
    const double l = 0.5 * (m.rest_length[i - 1] + m.rest_length[i]);
    m.bend[i] = 0.5 * (bend_element[i - 1] + bend_element[i]) / (l * l * l);
    // A clamp's last node has bending tissue on one side only, half an element long, and is straight on the other: its
    // second difference is half of the bend times l^2.
    const bool before = held(d, i - 1), here = held(d, i), after = held(d, i + 1);
    if (here && before && !after) m.bend[i] = 2 * bend_element[i] / (l * l * l);
    if (here && after && !before) m.bend[i] = 2 * bend_element[i - 1] / (l * l * l);
  }
}

void fill_shape(StrandModel& m) {
  m.bend_rest.assign(m.nodes, {});
  m.tangent_rest.assign(m.nodes, {1, 0, 0});
  for (int i = 1; i + 1 < m.nodes; ++i) {
    m.bend_rest[i] = second_difference(m.rest, i);
    m.tangent_rest[i] = chain_direction(m.rest, i, {1, 0, 0});
  }
  m.director_rest.assign(m.nodes, {0, 1, 0});
  m.director_rest[1] = any_perpendicular(m.tangent_rest[1]);
  for (int i = 2; i + 1 < m.nodes; ++i)
    m.director_rest[i] = carried(m.tangent_rest[i - 1], m.tangent_rest[i], m.director_rest[i - 1]);
}

/// Puts the linear strand's answer u to gravity into the rest shape: K u = f means that these tensions, bends and
/// foundation forces balance the weight where the strand is drawn.
void settle(StrandModel& m) {
  const int rows = 3 * m.nodes;
  std::vector<double> a(numerics::band_size(rows, kStrandBand), 0.0), u(rows, 0.0);
  for (int i = 0; i < m.nodes; ++i)
    for (int axis = 0; axis < 3; ++axis) u[3 * i + axis] = m.mass[i] * m.gravity[axis];
  for (int e = 0; e + 1 < m.nodes; ++e) {
    const Vec3d t = normalised(m.rest[e + 1] - m.rest[e]);
    const double c[2] = {-1, 1};
    add_term(a, e, c, 2, along(m.stretch[e] / m.rest_length[e], t));
  }
  for (int i = 1; i + 1 < m.nodes; ++i) add_term(a, i - 1, kBendStencil, 3, across(m.bend[i], m.tangent_rest[i]));
  for (int i = 0; i < m.nodes; ++i) {
    const double one[1] = {1};
    add_term(a, i, one, 1, isotropic(m.foundation[i]));
  }
  for (int p : m.prescribed_nodes) prescribe(a, u, m.nodes, p, {0, 0, 0});
  // A strand that nothing holds loses a pivot to rounding only: ask for more than that.
  std::vector<double> before(rows);
  for (int r = 0; r < rows; ++r) before[r] = a[numerics::band_at(kStrandBand, r, r)];
  bool held = numerics::band_factor(rows, kStrandBand, a.data()) < 0;
  for (int r = 0; held && r < rows; ++r) held = a[numerics::band_at(kStrandBand, r, r)] > 1e-11 * before[r];
  if (!held)
    refuse_strand(
        "something that holds the strand up (two prescribed nodes at an end, ends at both sides, or a foundation), "
        "or prestress = false");
  numerics::band_solve(rows, kStrandBand, a.data(), u.data());

  const auto at = [&](int i) { return Vec3d{u[3 * i], u[3 * i + 1], u[3 * i + 2]}; };
  for (int e = 0; e + 1 < m.nodes; ++e) {
    const double l = m.rest_length[e], k = m.stretch[e] / l;
    const double tension = k * dot(normalised(m.rest[e + 1] - m.rest[e]), at(e + 1) - at(e));
    // EA stays what it is: tension = EA shape(l_drawn / l_rest - 1).
    const double strain = inverse_shape(m.law, tension / m.stretch[e]);
    if (!(strain > -0.9)) refuse_strand("a strand stiff enough to carry its weight at element " + std::to_string(e));
    m.rest_length[e] = l / (1 + strain);
  }
  for (int i = 1; i + 1 < m.nodes; ++i) m.bend_rest[i] -= at(i - 1) - 2.0 * at(i) + at(i + 1);
  for (int i = 0; i < m.nodes; ++i) {
    const Vec3d pull = at(i);  // wanted: k s (1 + c |s|^2) = k u, s along u
    const double size = length(pull);
    if (!(m.foundation[i] > 0 && size > 0)) continue;
    double s = size;
    for (int step = 0; step < 60; ++step) s -= (s * (1 + m.stiffening * s * s) - size) / (1 + 3 * m.stiffening * s * s);
    m.foundation_point[i] = m.rest[i] - (s / size) * pull;
  }
}

}  // namespace

StrandModel build(const StrandDescription& d, double tick) {
  check(d, tick);
  StrandModel m;
  m.nodes = int(d.positions.size());
  m.tick = tick;
  m.law = d.law;
  m.rest = d.positions;
  m.radius = d.radius;
  m.lumen = d.lumen.empty() ? std::vector<double>(d.radius.size(), 0.0) : d.lumen;
  m.foundation = d.foundation.empty() ? std::vector<double>(m.nodes, 0.0) : d.foundation;
  m.foundation_point = d.positions;
  m.stiffening = d.foundation_stiffening;
  m.prescribed = d.prescribed.empty() ? std::vector<std::uint8_t>(m.nodes, 0) : d.prescribed;
  for (int i = 0; i < m.nodes; ++i)
    if (m.prescribed[i]) m.prescribed_nodes.push_back(i);
  m.damping_time = d.damping_time;
  m.foundation_damping_time = d.foundation_damping_time;
  m.gamma = d.global_damping;
  m.gravity = d.gravity;
  fill_sections(m, d);
  fill_shape(m);
  if (d.prestress && dot(d.gravity, d.gravity) > 0) settle(m);
  return m;
}

StrandState rest_state(const StrandModel& m) {
  StrandState s;
  s.x = m.rest;
  s.v.assign(m.nodes, {});
  s.scale.assign(m.nodes - 1, 1.0);
  s.alive.assign(m.nodes - 1, 1);
  s.foundation_scale.assign(m.nodes, 1.0);
  return s;
}

StrandWork make_work(const StrandModel& m) {
  const int rows = 3 * m.nodes;
  StrandWork w;
  w.matrix.resize(numerics::band_size(rows, kStrandBand));
  w.saved.resize(3 * kStrandReach * m.prescribed_nodes.size());
  w.rhs.resize(rows);
  w.force.resize(3 * m.prescribed_nodes.size());
  w.direction.resize(m.nodes);
  w.bend_now.resize(m.nodes);
  w.columns.resize(m.prescribed_nodes.empty() ? 0 : std::size_t(rows) * 3);
  return w;
}

}  // namespace trocar::tissue

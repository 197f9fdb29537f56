#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/suture/thread/chain.hpp>
#include <trocar/suture/thread/contacts.hpp>
#include <trocar/suture/thread/spin.hpp>

namespace trocar::suture {
namespace {

/// atan2(y, x), by its series where the angle is small.
double angle_between(double x, double y) {
  const double r = y / x, r2 = r * r;
  if (!(x > 0 && r2 < 0.04)) return portable::atan2(y, x);
  return r * (1 - r2 * (1.0 / 3 - r2 * (1.0 / 5 - r2 * (1.0 / 7 - r2 * (1.0 / 9 - r2 * (1.0 / 11 - r2 / 13))))));
}

/// Friction takes part in spin: the surfaces' motion is that of the axes and their spin about them. Both sides spin at
/// once, so each may only count on half of the spring.
void add_friction(const ThreadModel& m, const Touch& touch, bool both, ThreadWork& w) {
  const double arm = 0.5 * m.stuff.diameter;
  const int sides = both ? 2 : 1;
  for (int side = 0; side < sides; ++side) {
    const int e = side == 0 ? touch.a : touch.b;
    // the surface point of the first lies at -arm normal, that of the second at +arm normal
    const Vec3d g = (-arm) * cross(w.along[e], touch.normal);
    w.spin_diagonal[e] += sides * touch.rub_stiffness * dot(g, g);
    w.spin[e] -= touch.rub_stiffness * dot(g, touch.strain);
  }
}

/// A bend that stays is fixed in the thread's material: it resists being turned about the axis away from how the thread
/// is bent there. Both elements beside the node turn it by half.
void add_bend(const ThreadModel& m, const ThreadState& s, int i, ThreadWork& w) {
  const double yield = m.stuff.yield_curvature * m.spacing;
  if (!(yield > 0) || m.shaped) return;
  const double k = m.stuff.bend / m.spacing * kept_share(yield, s.bend[i].z);
  const double moment = k * dot(w.bend_now[i], cross(w.node_along[i], w.bend_rest[i]));
  const double stiffness = 0.25 * std::fabs(k * dot(w.bend_now[i], w.bend_rest[i]));
  w.spin_diagonal[i - 1] += stiffness, w.spin_diagonal[i] += stiffness, w.spin_off[i - 1] += stiffness;
  w.spin[i - 1] += 0.5 * moment, w.spin[i] += 0.5 * moment;
}

void move_strain(const ThreadModel& m, bool both, const ThreadWork& w, Touch& touch) {
  const double arm = 0.5 * m.stuff.diameter;
  touch.strain += (-arm * w.spin[touch.a]) * cross(w.along[touch.a], touch.normal);
  if (both) touch.strain += (-arm * w.spin[touch.b]) * cross(w.along[touch.b], touch.normal);
}

}  // namespace

void measure_twist(const ThreadModel& m, ThreadState& s, const ThreadWork& w) noexcept {
  for (int i = 1; i + 1 < m.nodes; ++i) {
    if (!s.alive[i - 1] || !s.alive[i]) {
      s.twist[i] = 0;
      continue;
    }
    const Vec3d t = w.along[i], d = turned(w.along[i - 1], t, s.director[i - 1]), e = s.director[i];
    const double angle = angle_between(dot(d, e), dot(cross(d, e), t));
    s.twist[i] = angle + portable::two_pi * std::floor((s.twist[i] - angle) / portable::two_pi + 0.5);
  }
}

void relax_spin(const ThreadModel& m, std::span<const SpinHold> holds, int self, int touching, ThreadState& s,
                ThreadWork& w) noexcept {
  const int elements = m.nodes - 1;
  const double c = m.stuff.twist / m.spacing;
  for (int e = 0; e < elements; ++e) w.spin_diagonal[e] = 1e-6 * c, w.spin_off[e] = w.spin[e] = 0;
  for (int i = 1; i < elements; ++i) {
    if (!s.alive[i - 1] || !s.alive[i]) continue;
    w.spin_diagonal[i - 1] += c, w.spin_diagonal[i] += c, w.spin_off[i - 1] -= c;
    w.spin[i - 1] += c * s.twist[i], w.spin[i] -= c * s.twist[i];
    add_bend(m, s, i, w);
  }
  for (const SpinHold& hold : holds) {
    const int e = hold.element;
    const Vec3d t = w.along[e], d = s.director[e];
    const double angle = portable::atan2(dot(cross(d, hold.wanted), t), dot(d, hold.wanted));
    w.spin_diagonal[e] += 100 * c, w.spin[e] += 100 * c * angle;
  }
  for (int k = 0; k < self; ++k) add_friction(m, w.self[k], true, w);
  for (int k = 0; k < touching; ++k) add_friction(m, w.touch[k], false, w);

  for (int e = 0; e + 1 < elements; ++e) {  // tridiagonal, symmetric
    const double l = w.spin_off[e] / w.spin_diagonal[e];
    w.spin_diagonal[e + 1] -= l * w.spin_off[e];
    w.spin[e + 1] -= l * w.spin[e];
  }
  for (int e = elements - 1; e >= 0; --e) {
    const double next = e + 1 < elements ? w.spin_off[e] * w.spin[e + 1] : 0;
    w.spin[e] = (w.spin[e] - next) / w.spin_diagonal[e];
  }
  for (int e = 0; e < elements; ++e) {
    double& spin = w.spin[e];
    spin = spin > 0.5 ? 0.5 : (spin < -0.5 ? -0.5 : spin);
    if (spin == 0) continue;
    const Vec3d t = w.along[e], d = s.director[e];
    const double cosine = 1 - 0.5 * spin * spin * (1 - spin * spin / 12);  // near enough: it is made a unit again
    s.director[e] = normalised(cosine * d + spin * (1 - spin * spin / 6) * cross(t, d), d);
  }
  for (int k = 0; k < self; ++k) move_strain(m, true, w, w.self[k]);
  for (int k = 0; k < touching; ++k) move_strain(m, false, w, w.touch[k]);
  for (int i = 1; i < elements; ++i)
    if (s.alive[i - 1] && s.alive[i]) {
      s.twist[i] += w.spin[i] - w.spin[i - 1];
      const double spin = 0.5 * (w.spin[i] + w.spin[i - 1]);
      const Vec3d d = w.node_director[i];
      w.node_director[i] = normalised(d + spin * cross(w.node_along[i], d), d);
    }
}

void add_twist(const ThreadModel& m, const ThreadState& s, ThreadWork& w) noexcept {
  if (m.shaped) return;
  const double c = m.stuff.twist / m.spacing;
  for (int i = 1; i + 1 < m.nodes; ++i) {
    if (!s.alive[i - 1] || !s.alive[i]) continue;
    const Vec3d d = s.x[i] - s.x[i - 1], e = s.x[i + 1] - s.x[i];
    const double ld = length(d), le = length(e), turn = ld * le + dot(d, e);
    const Vec3d binormal = (2 / (turn > 0.02 * ld * le ? turn : 0.02 * ld * le)) * cross(d, e);
    // d twist / d x along the binormal, directors carried along without spin [Bergou et al. 10]
    const std::int32_t nodes[3] = {i - 1, i, i + 1};
    const double g[3] = {-0.5 / ld, 0.5 / ld - 0.5 / le, 0.5 / le};
    const Vec3d f = -c * s.twist[i] * binormal;
    for (int j = 0; j < 3; ++j) w.system.push(nodes[j], g[j] * f);
    // In a knot spin gives way at once, and nodes that met this stiffness in each solve would creep.
    if (w.system.touches(i - 1) || w.system.touches(i) || w.system.touches(i + 1)) continue;
    const double size2 = dot(binormal, binormal);
    if (size2 > 0) w.system.add_term(nodes, g, 3, along_and_across(c * size2, 0, (1 / std::sqrt(size2)) * binormal));
  }
}

}  // namespace trocar::suture

#include <algorithm>
#include <cmath>

#include <trocar/kinematics/dynamics/dynamics.hpp>
#include <trocar/kinematics/loops/conditions.hpp>

namespace trocar::kinematics {

DynamicsWork::DynamicsWork(const Mechanism& m)
    : pose(m), across(std::max(m.rows, 1), m.u_count()), back(m.u_count(), std::max(m.rows, 1)) {
  const auto n = std::size_t(m.u_count()), rows = std::size_t(m.rows);
  for (std::vector<double>* v : {&dq, &ddq, &tau}) v->resize(m.coordinates.size());
  for (std::vector<Twist>* v : {&speeds, &bias, &wrench}) v->resize(m.bodies.size());
  columns.resize(n);
  for (std::vector<double>* v : {&mass, &factor}) v->resize(n * n);
  for (std::vector<double>* v : {&force, &acceleration, &a, &b, &u0, &du0, &sum_u, &sum_du, &k_u, &k_du}) v->resize(n);
  for (std::vector<double>* v : {&residual, &curvature, &multipliers, &c}) v->resize(rows);
  for (std::vector<double>* v : {&slope, &square}) v->resize(rows * n);
}

const char* words(MotionStatus status) noexcept {
  switch (status) {
    case MotionStatus::good:
      return "good";
    case MotionStatus::massless:
      return "a coordinate moves no mass: give its link a mass or an inertia";
    case MotionStatus::open:
      return "loops came open: take a shorter step, or begin away from a singular pose";
    case MotionStatus::not_finite:
      return "speeds without bounds: take a shorter step";
  }
  return "";
}

namespace {

constexpr double kDependent = 1e-9;  // pivots of conditions below this times the largest are none

Mat3d turned_inertia(const Body& b, const Mat3d& r) noexcept { return r * b.inertia * transposed(r); }

/// Accelerations of bodies at coordinates' accelerations `ddq`, or of speeds alone (null); no gravity in them.
void accelerations(const Mechanism& m, const DynamicsWork& w, const double* ddq, std::span<Twist> out) noexcept {
  out[0] = {};
  for (std::size_t i = 1; i < m.bodies.size(); ++i) {
    const Body& b = m.bodies[i];
    const Twist &of = out[std::size_t(b.parent)], &v = w.speeds[std::size_t(b.parent)];
    const Vec3d s = w.pose.frames[i].p - w.pose.frames[std::size_t(b.parent)].p;
    Twist t{of.turn, of.move + cross(of.turn, s) + cross(v.turn, cross(v.turn, s))};
    if (b.motion != Motion::none) {
      const Vec3d rate = w.dq[std::size_t(b.coordinate)] * w.pose.axes[i];
      const double more = ddq ? ddq[b.coordinate] : 0;
      if (b.motion == Motion::turn)
        t.turn += cross(v.turn, rate) + more * w.pose.axes[i];
      else
        t.move += 2.0 * cross(v.turn, rate) + more * w.pose.axes[i];
    }
    out[i] = t;
  }
}

/// What springs pull at bodies, added to wrenches.
void add_springs(const Mechanism& m, DynamicsWork& w) noexcept {
  for (const BodySpring& s : m.springs) {
    const Vec3d a = place(s.a, w.pose).p, b = place(s.b, w.pose).p, apart = b - a;
    const double size = length(apart);
    if (!(size > 1e-12)) continue;  // no direction
    const auto arm = [&](int body, Vec3d p) { return p - w.pose.frames[std::size_t(body)].p; };
    const auto speed = [&](int body, Vec3d p) {
      const Twist& t = w.speeds[std::size_t(body)];
      return t.move + cross(t.turn, arm(body, p));
    };
    const Vec3d along = apart / size;
    const double rate = dot(along, speed(s.b.body, b) - speed(s.a.body, a));
    const Vec3d pull = (s.stiffness * (size - s.rest) + s.damping * rate) * along;  // on a
    Twist &on_a = w.wrench[std::size_t(s.a.body)], &on_b = w.wrench[std::size_t(s.b.body)];
    on_a.move += pull;
    on_a.turn += cross(arm(s.a.body, a), pull);
    on_b.move -= pull;
    on_b.turn -= cross(arm(s.b.body, b), pull);
  }
}

/// Forces of independent coordinates: gravity and springs, less what bodies need for the accelerations in w.bias.
void newton_euler(const Mechanism& m, DynamicsWork& w) noexcept {
  for (std::size_t i = 0; i < m.bodies.size(); ++i) {
    const Body& b = m.bodies[i];
    const Frame& f = w.pose.frames[i];
    const Vec3d s = f.r * b.centre, omega = w.speeds[i].turn, alpha = w.bias[i].turn;
    const Vec3d at_centre = w.bias[i].move + cross(alpha, s) + cross(omega, cross(omega, s));
    const Mat3d inertia = turned_inertia(b, f.r);
    const Vec3d push = b.mass * (m.gravity - at_centre);
    w.wrench[i] = {cross(s, push) - inertia * alpha - cross(omega, inertia * omega), push};
  }
  add_springs(m, w);
  std::fill(w.tau.begin(), w.tau.end(), 0.0);
  for (std::size_t i = m.bodies.size() - 1; i > 0; --i) {
    const Body& b = m.bodies[i];
    const Twist& t = w.wrench[i];
    if (b.motion == Motion::turn) w.tau[std::size_t(b.coordinate)] += dot(w.pose.axes[i], t.turn);
    if (b.motion == Motion::slide) w.tau[std::size_t(b.coordinate)] += dot(w.pose.axes[i], t.move);
    Twist& of = w.wrench[std::size_t(b.parent)];
    of.move += t.move;
    of.turn += t.turn + cross(w.pose.frames[i].p - w.pose.frames[std::size_t(b.parent)].p, t.move);
  }
  std::fill(w.force.begin(), w.force.end(), 0.0);
  for (std::size_t i = 0; i < m.coordinates.size(); ++i)
    for (int e = m.expand_start[i]; e < m.expand_start[i + 1]; ++e)
      w.force[std::size_t(m.expand[std::size_t(e)].u)] += m.expand[std::size_t(e)].ratio * w.tau[i];
}

void mass_matrix(const Mechanism& m, DynamicsWork& w) noexcept {
  const std::size_t n = w.force.size();
  std::fill(w.mass.begin(), w.mass.end(), 0.0);
  for (std::size_t k = 1; k < m.bodies.size(); ++k) {
    const Body& b = m.bodies[k];
    if (b.mass == 0 && trace(b.inertia) == 0) continue;
    const Frame& f = w.pose.frames[k];
    const Mat3d inertia = turned_inertia(b, f.r);
    jacobian(m, w.pose, int(k), f * b.centre, w.columns);
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3d push = b.mass * w.columns[i].move, turn = inertia * w.columns[i].turn;
      for (std::size_t j = 0; j <= i; ++j)
        w.mass[i * n + j] += dot(push, w.columns[j].move) + dot(turn, w.columns[j].turn);
    }
  }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < i; ++j) w.mass[j * n + i] = w.mass[i * n + j];
}

/// M = L L^T. False where M is not definite.
bool cholesky(std::size_t n, const std::vector<double>& mass, std::vector<double>& l) noexcept {
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i) largest = std::max(largest, mass[i * n + i]);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = mass[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= l[i * n + k] * l[j * n + k];
      if (i != j)
        l[i * n + j] = sum / l[j * n + j];
      else if (!(sum > 1e-14 * mass[i * n + i]) || !(sum > 0))
        return false;
      else
        l[i * n + i] = std::sqrt(sum);
    }
  return true;
}
/// x = L^-1 x
void lower(std::size_t n, const std::vector<double>& l, double* x) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= l[i * n + k] * x[k];
    x[i] /= l[i * n + i];
  }
}
/// x = L^-T x
void upper(std::size_t n, const std::vector<double>& l, double* x) noexcept {
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) x[i] -= l[k * n + i] * x[k];
    x[i] /= l[i * n + i];
  }
}

/// Scales a condition's row: metres by the mechanism's length, so that pivots compare.
double row_scale(const Mechanism& m, int row) noexcept {
  for (const Closure& c : m.closures) {
    if (row < c.count) return is_length(c.conditions[std::size_t(row)]) ? 1 / m.length : 1;
    row -= c.count;
  }
  return 1;
}

/// Pose, speeds, M, and the conditions in the metric of masses, factored. False: massless.
bool prepare(const Mechanism& m, const MotionState& s, DynamicsWork& w) noexcept {
  const std::size_t n = w.force.size(), rows = w.residual.size();
  forward(m, s.u, w.pose);
  velocities(m, w.pose, s.du, w.dq, w.speeds);
  mass_matrix(m, w);
  if (!cholesky(n, w.mass, w.factor)) return false;
  if (rows == 0) return true;
  slopes(m, m.closures, w.pose, w.slope.data(), int(rows));
  double* b = w.across.matrix(int(rows), int(n));
  for (std::size_t i = 0; i < rows; ++i) {
    const double by = row_scale(m, int(i));
    double* y = w.square.data() + i * n;
    for (std::size_t k = 0; k < n; ++k) y[k] = by * w.slope[k * rows + i];
    lower(n, w.factor, y);
    for (std::size_t k = 0; k < n; ++k) b[k * rows + i] = y[k];
  }
  w.across.factor(kDependent);
  return true;
}

/// x -= L^-T B^+ r, r in conditions' own units. (x in coordinates)
void correct(const Mechanism& m, DynamicsWork& w, const std::vector<double>& r, std::vector<double>& x) noexcept {
  const std::size_t n = w.force.size(), rows = r.size();
  for (std::size_t i = 0; i < rows; ++i) w.c[i] = row_scale(m, int(i)) * r[i];
  w.across.solve(w.c.data(), w.b.data());
  upper(n, w.factor, w.b.data());
  for (std::size_t k = 0; k < n; ++k) x[k] -= w.b[k];
}

bool all_finite(const std::vector<double>& v) noexcept {
  return std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x) && std::fabs(x) < 1e12; });
}

}  // namespace

MotionStatus accelerate(const Mechanism& m, Torques torques, const MotionState& s, DynamicsWork& w) noexcept {
  const std::size_t n = w.force.size(), rows = w.residual.size();
  if (!prepare(m, s, w)) return MotionStatus::massless;
  accelerations(m, w, nullptr, w.bias);
  newton_euler(m, w);
  for (std::size_t k = 0; k < n; ++k) w.a[k] = w.force[k] + (k < torques.size() ? torques[k] : 0);
  lower(n, w.factor, w.a.data());  // L^T ddu without loops
  if (rows > 0) {
    curvatures(m.closures, w.pose, w.speeds, w.bias, w.curvature.data());
    for (std::size_t i = 0; i < rows; ++i) {
      double sum = -row_scale(m, int(i)) * w.curvature[i];
      for (std::size_t k = 0; k < n; ++k) sum -= w.square[i * n + k] * w.a[k];
      w.c[i] = sum;
    }
    w.across.solve(w.c.data(), w.b.data());  // what loops add to it
    double* t = w.back.matrix(int(n), int(rows));
    std::copy(w.square.begin(), w.square.end(), t);
    w.back.factor(kDependent);
    w.back.solve(w.b.data(), w.multipliers.data());
    for (std::size_t i = 0; i < rows; ++i) w.multipliers[i] *= row_scale(m, int(i));
    for (std::size_t k = 0; k < n; ++k) w.a[k] += w.b[k];
  }
  upper(n, w.factor, w.a.data());
  w.acceleration = w.a;
  return all_finite(w.acceleration) ? MotionStatus::good : MotionStatus::not_finite;
}

MotionStatus project(const Mechanism& m, MotionState& s, DynamicsWork& w) noexcept {
  if (m.rows == 0) return all_finite(s.u) && all_finite(s.du) ? MotionStatus::good : MotionStatus::not_finite;
  double last = 1e300;
  for (int k = 0; k < 30; ++k) {
    if (!prepare(m, s, w)) return MotionStatus::massless;
    residuals(m.closures, w.pose, w.residual.data());
    double size = 0;
    for (std::size_t i = 0; i < w.residual.size(); ++i)
      size = std::max(size, std::fabs(w.residual[i]) * row_scale(m, int(i)));
    if (!std::isfinite(size)) return MotionStatus::not_finite;
    if (size < 1e-13 || (size < 1e-11 && size > 0.3 * last)) break;
    if (k == 29) return MotionStatus::open;
    last = size;
    correct(m, w, w.residual, s.u);
  }
  const std::size_t n = s.u.size(), rows = w.residual.size();
  for (std::size_t i = 0; i < rows; ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) sum += w.slope[k * rows + i] * s.du[k];
    w.residual[i] = sum;
  }
  correct(m, w, w.residual, s.du);
  return all_finite(s.u) && all_finite(s.du) ? MotionStatus::good : MotionStatus::not_finite;
}

MotionStatus step(const Mechanism& m, Torques torques, double dt, MotionState& s, DynamicsWork& w) noexcept {
  const std::size_t n = s.u.size();
  w.u0 = s.u;
  w.du0 = s.du;
  std::fill(w.sum_u.begin(), w.sum_u.end(), 0.0);
  std::fill(w.sum_du.begin(), w.sum_du.end(), 0.0);
  constexpr double kAt[] = {0, 0.5, 0.5, 1}, kWeight[] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
  MotionStatus status = MotionStatus::good;
  for (int stage = 0; stage < 4 && status == MotionStatus::good; ++stage) {
    if (stage > 0)
      for (std::size_t k = 0; k < n; ++k) {
        s.u[k] = w.u0[k] + kAt[stage] * dt * w.k_u[k];
        s.du[k] = w.du0[k] + kAt[stage] * dt * w.k_du[k];
      }
    status = accelerate(m, torques, s, w);
    for (std::size_t k = 0; k < n; ++k) {
      w.k_u[k] = s.du[k];
      w.k_du[k] = w.acceleration[k];
      w.sum_u[k] += kWeight[stage] * w.k_u[k];
      w.sum_du[k] += kWeight[stage] * w.k_du[k];
    }
  }
  if (status == MotionStatus::good) {
    for (std::size_t k = 0; k < n; ++k) {
      s.u[k] = w.u0[k] + dt * w.sum_u[k];
      s.du[k] = w.du0[k] + dt * w.sum_du[k];
    }
    status = project(m, s, w);
  }
  if (status != MotionStatus::good) {
    s.u = w.u0;
    s.du = w.du0;
  }
  return status;
}

double inverse_dynamics(const Mechanism& m, const MotionState& s, std::span<const double> acceleration,
                        std::span<const int> driven, std::span<double> torques, DynamicsWork& w) {
  const std::size_t n = s.u.size(), rows = w.residual.size();
  forward(m, s.u, w.pose);
  velocities(m, w.pose, s.du, w.dq, w.speeds);
  expand_speeds(m, acceleration, w.ddq);
  accelerations(m, w, w.ddq.data(), w.bias);
  newton_euler(m, w);  // what is missing for this motion is -force
  slopes(m, m.closures, w.pose, w.slope.data(), int(rows));
  numerics::PivotedQr qr(int(n), int(driven.size() + rows));
  double* a = qr.matrix(int(n), int(driven.size() + rows));
  std::fill_n(a, n * (driven.size() + rows), 0.0);
  for (std::size_t d = 0; d < driven.size(); ++d) a[d * n + std::size_t(driven[d])] = 1;
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t k = 0; k < n; ++k) a[(driven.size() + i) * n + k] = w.slope[k * rows + i];
  std::vector<double> matrix(a, a + n * (driven.size() + rows)), x(driven.size() + rows), missing(n);
  for (std::size_t k = 0; k < n; ++k) missing[k] = -w.force[k];
  qr.factor(1e-10);
  qr.solve(missing.data(), x.data());
  std::fill(torques.begin(), torques.end(), 0.0);
  for (std::size_t d = 0; d < driven.size(); ++d) torques[std::size_t(driven[d])] = x[d];
  double largest = 0;
  for (std::size_t k = 0; k < n; ++k) {
    double left = missing[k];
    for (std::size_t j = 0; j < x.size(); ++j) left -= matrix[j * n + k] * x[j];
    largest = std::max(largest, std::fabs(left));
  }
  return largest;
}

Energy energy(const Mechanism& m, const MotionState& s, DynamicsWork& w) noexcept {
  forward(m, s.u, w.pose);
  velocities(m, w.pose, s.du, w.dq, w.speeds);
  Energy e;
  for (std::size_t i = 1; i < m.bodies.size(); ++i) {
    const Body& b = m.bodies[i];
    const Frame& f = w.pose.frames[i];
    const Vec3d omega = w.speeds[i].turn, v = w.speeds[i].move + cross(omega, f.r * b.centre);
    e.kinetic += 0.5 * (b.mass * dot(v, v) + dot(omega, turned_inertia(b, f.r) * omega));
    e.potential -= b.mass * dot(m.gravity, f * b.centre);
  }
  for (const BodySpring& spring : m.springs) {
    const double more = length(place(spring.b, w.pose).p - place(spring.a, w.pose).p) - spring.rest;
    e.potential += 0.5 * spring.stiffness * more * more;
  }
  return e;
}

}  // namespace trocar::kinematics

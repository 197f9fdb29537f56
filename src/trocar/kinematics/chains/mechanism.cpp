#include <algorithm>
#include <cmath>

#include <trocar/kinematics/chains/mechanism.hpp>

namespace trocar::kinematics {
namespace {

template <class List>
int number_of(const List& list, std::string_view name) noexcept {
  for (std::size_t i = 0; i < list.size(); ++i)
    if (list[i] == name) return int(i);
  return -1;
}
template <class List>
int number_of_named(const List& list, std::string_view name) noexcept {
  for (std::size_t i = 0; i < list.size(); ++i)
    if (list[i].name == name) return int(i);
  return -1;
}

Vec3d three_of(const double* d) noexcept { return {d[0], d[1], d[2]}; }

/// [Craig 1989] Rot_x(alpha) Move_x(a) Rot_z(theta) Move_z(d)
Frame placed(const double* d, bool dh) noexcept {
  if (!dh) return {turn_xyz(three_of(d + 3)), three_of(d)};
  const Frame first{turn_about({1, 0, 0}, d[3]), {}};
  return first * Frame{turn_about({0, 0, 1}, d[5]), {d[0], 0, d[2]}};
}

}  // namespace

int Mechanism::link(std::string_view of) const noexcept { return number_of(links, of); }
int Mechanism::coordinate(std::string_view of) const noexcept { return number_of(coordinates, of); }
int Mechanism::independent_of(std::string_view of) const noexcept {
  const int q = coordinate(of);
  for (std::size_t i = 0; i < independent.size(); ++i)
    if (independent[i] == q && q >= 0) return int(i);
  return -1;
}
int Mechanism::parameter(std::string_view of) const noexcept { return number_of_named(parameters, of); }
int Mechanism::frame(std::string_view of) const noexcept { return number_of(frame_names, of); }
int Mechanism::drive(std::string_view of) const noexcept { return number_of_named(drives, of); }

double Mechanism::scale(int u) const noexcept {
  return measures[std::size_t(independent[std::size_t(u)])] == Measure::length ? length : 1;
}

std::vector<double> Mechanism::start_u() const {
  std::vector<double> u;
  for (const int i : independent) u.push_back(start[std::size_t(i)]);
  return u;
}

Mechanism Mechanism::with(std::span<const double> values) const {
  Mechanism other = *this;
  other.assign(values);
  return other;
}

void Mechanism::assign(std::span<const double> values) noexcept {
  if (values.data() != parameter_values.data()) std::copy(values.begin(), values.end(), parameter_values.begin());
  for (std::size_t i = 0; i < base.size(); ++i) {
    double sum = base[i];
    for (int t = term_start[i]; t < term_start[i + 1]; ++t)
      sum += terms[std::size_t(t)].factor * parameter_values[std::size_t(terms[std::size_t(t)].parameter)];
    dimensions[i] = sum;
  }
  const auto at = [this](int first) { return dimensions.data() + first; };
  places.resize(bodies.size());  // once: they are as many ever after
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (bodies[i].dimensions >= 0) places[i] = placed(at(bodies[i].dimensions), bodies[i].dh);
  const auto set = [&](BodyFrame& f) {
    if (f.dimensions >= 0) f.local = placed(at(f.dimensions), f.dh);
  };
  for (BodyFrame& f : frames) set(f);
  for (Closure& c : closures) set(c.a), set(c.b);
  for (BodySpring& s : springs) set(s.a), set(s.b);
  for (Drive& d : drives) {
    d.at_0 = *at(d.dimensions);
    d.at_1 = *at(d.dimensions + 1);
  }
  for (BodyShape& s : shapes) {
    s.from = three_of(at(s.dimensions));
    s.to = three_of(at(s.dimensions + 3));
    if (s.kind == ShapeKind::box)
      s.turn = turn_xyz(three_of(at(s.dimensions + 6)));
    else
      s.radius = *at(s.dimensions + 6);
  }
  for (const int i : dependents) {
    const auto row = [this](int k) {
      return std::span(expand).subspan(std::size_t(expand_start[std::size_t(k)]),
                                       std::size_t(expand_start[std::size_t(k) + 1] - expand_start[std::size_t(k)]));
    };
    for (Entry& e : row(i)) e.ratio = 0;
    double& constant = offset[std::size_t(i)];
    constant = offset_dimension[std::size_t(i)] < 0 ? 0 : *at(offset_dimension[std::size_t(i)]);
    for (int s = share_start[std::size_t(i)]; s < share_start[std::size_t(i) + 1]; ++s) {
      const Share& share = shares[std::size_t(s)];
      const double ratio = share.factor * *at(share.dimension);
      constant += ratio * offset[std::size_t(share.of)];
      for (const Entry& from : row(share.of))
        for (Entry& to : row(i))
          if (to.u == from.u) to.ratio += ratio * from.ratio;
    }
  }
}

void set_directions(Closure& c, unsigned directions) noexcept {
  using Kind = Condition::Kind;
  c.directions = directions;
  c.count = 0;
  const auto add = [&](Kind kind, int i, int k) {
    c.conditions[std::size_t(c.count++)] = {kind, static_cast<unsigned char>(i), static_cast<unsigned char>(k)};
  };
  for (int i = 0; i < 3; ++i)
    if (directions & (kTx << i)) add(Kind::along, i, 0);
  const unsigned turns = directions & kR;
  if (turns == kR) {
    for (int i = 0; i < 3; ++i) add(Kind::twist, i, 0);
    return;
  }
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    if (turns == (kR & ~(kRx << k))) {  // free about k: its axis of one is square to the others of the other
      add(Kind::square, i, k);
      add(Kind::square, j, k);
    } else if (turns == (unsigned(kRx) << k)) {  // no turn about k alone
      add(Kind::square, i, j);
    }
  }
}

Pose::Pose(const Mechanism& m) : q(m.coordinates.size()), frames(m.bodies.size()), axes(m.bodies.size()) {}

void forward(const Mechanism& m, std::span<const double> u, Pose& pose) noexcept {
  for (std::size_t i = 0; i < pose.q.size(); ++i) {
    double sum = m.offset[i];
    for (int k = m.expand_start[i]; k < m.expand_start[i + 1]; ++k)
      sum += m.expand[std::size_t(k)].ratio * u[std::size_t(m.expand[std::size_t(k)].u)];
    pose.q[i] = sum;
  }
  for (std::size_t i = 1; i < m.bodies.size(); ++i) {
    const Body& b = m.bodies[i];
    Frame f = pose.frames[std::size_t(b.parent)];
    if (b.dimensions >= 0) f = f * m.places[i];
    if (b.motion != Motion::none) {
      const double q = pose.q[std::size_t(b.coordinate)];
      pose.axes[i] = f.r * b.axis;
      if (b.motion == Motion::turn)
        f.r = f.r * turn_about(b.axis, q);
      else
        f.p += q * pose.axes[i];
    }
    pose.frames[i] = f;
  }
}

void jacobian(const Mechanism& m, const Pose& pose, int body, Vec3d point, std::span<Twist> out) noexcept {
  std::fill(out.begin(), out.end(), Twist{});
  for (int i = body; i > 0; i = m.bodies[std::size_t(i)].parent) {
    const Body& b = m.bodies[std::size_t(i)];
    if (b.motion == Motion::none) continue;
    const Vec3d axis = pose.axes[std::size_t(i)];
    Twist t;
    if (b.motion == Motion::turn)
      t = {axis, cross(axis, point - pose.frames[std::size_t(i)].p)};
    else
      t.move = axis;
    for (int k = m.expand_start[std::size_t(b.coordinate)]; k < m.expand_start[std::size_t(b.coordinate) + 1]; ++k) {
      const Mechanism::Entry& e = m.expand[std::size_t(k)];
      out[std::size_t(e.u)].turn += e.ratio * t.turn;
      out[std::size_t(e.u)].move += e.ratio * t.move;
    }
  }
}

void expand_speeds(const Mechanism& m, std::span<const double> du, std::span<double> dq) noexcept {
  for (std::size_t i = 0; i < m.coordinates.size(); ++i) {
    double sum = 0;
    for (int k = m.expand_start[i]; k < m.expand_start[i + 1]; ++k)
      sum += m.expand[std::size_t(k)].ratio * du[std::size_t(m.expand[std::size_t(k)].u)];
    dq[i] = sum;
  }
}

void velocities(const Mechanism& m, const Pose& pose, std::span<const double> du, std::span<double> dq,
                std::span<Twist> out) noexcept {
  expand_speeds(m, du, dq);
  out[0] = {};
  for (std::size_t i = 1; i < m.bodies.size(); ++i) {
    const Body& b = m.bodies[i];
    const Twist& of = out[std::size_t(b.parent)];
    Twist t{of.turn, of.move + cross(of.turn, pose.frames[i].p - pose.frames[std::size_t(b.parent)].p)};
    if (b.motion == Motion::turn) t.turn += dq[std::size_t(b.coordinate)] * pose.axes[i];
    if (b.motion == Motion::slide) t.move += dq[std::size_t(b.coordinate)] * pose.axes[i];
    out[i] = t;
  }
}

int beyond_limits(const Mechanism& m, std::span<const double> q, double slack) noexcept {
  for (std::size_t i = 0; i < m.coordinates.size(); ++i)
    if (q[i] < m.low[i] - slack || q[i] > m.high[i] + slack) return int(i);
  return -1;
}

}  // namespace trocar::kinematics

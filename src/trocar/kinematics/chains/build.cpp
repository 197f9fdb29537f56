#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include <trocar/kinematics/chains/joints.hpp>
#include <trocar/kinematics/chains/mechanism.hpp>

namespace trocar::kinematics {
namespace {

constexpr const char* kAxisNames[] = {"x", "y", "z"};

class Building {
 public:
  explicit Building(const MechanismDescription& d) : m_d(d) {}

  Mechanism build() {
    m.name = m_d.name;
    m.gravity = m_d.gravity;
    m.parameters = m_d.parameters;
    m.named_parameters = int(m.parameters.size());
    for (const Parameter& p : m_d.parameters) m.parameter_values.push_back(p.value);
    m.term_start.push_back(0);
    coordinates();
    bodies();
    couplings();
    for (const Actuator& a : m_d.actuators) actuator(a);
    for (const NamedFrame& f : m_d.frames) {
      m.frame_names.push_back(f.name);
      m.frames.push_back(frame(f, f.name));
    }
    for (const LoopClosure& c : m_d.closures) closure(c);
    for (const PointSpring& s : m_d.springs) {
      m.spring_names.push_back(s.name);
      m.springs.push_back({frame(s.a, s.name + ".a"), frame(s.b, s.name + ".b"), s.stiffness, s.damping, s.rest});
    }
    m.dimensions = m.base;
    const std::vector<double> values = m.parameter_values;
    m.assign(values);
    measure_length();
    return std::move(m);
  }

 private:
  /// @return its number
  int dimension(const Quantity& q, Measure measure, const std::string& name) {
    const bool own = q.terms.empty();
    m.base.push_back(own ? 0 : q.constant);
    if (own) {
      m.terms.push_back({int(m.parameters.size()), 1});
      m.parameters.push_back({name, measure, q.constant});
      m.parameter_values.push_back(q.constant);
    }
    for (const Quantity::Term& t : q.terms) m.terms.push_back({t.parameter, t.factor});
    m.term_start.push_back(int(m.terms.size()));
    return int(m.base.size()) - 1;
  }
  int three(const Quantities& q, Measure measure, const std::string& name) {
    const int first = int(m.base.size());
    for (std::size_t k = 0; k < 3; ++k) dimension(q[k], measure, name + "." + kAxisNames[k]);
    return first;
  }
  int placement(const Placement& p, const std::string& name) {
    if (!p.dh) {
      const int first = three(p.at, Measure::length, name + ".at");
      three(p.turn, Measure::angle, name + ".turn");
      return first;
    }
    const int first = dimension(p.at[0], Measure::length, name + ".a");
    dimension({0, {{0, 0}}}, Measure::length, name);  // not in use, and so no parameter
    dimension(p.at[2], Measure::length, name + ".d");
    dimension(p.turn[0], Measure::angle, name + ".alpha");
    dimension({0, {{0, 0}}}, Measure::angle, name);
    dimension(p.turn[2], Measure::angle, name + ".theta");
    return first;
  }
  BodyFrame frame(const NamedFrame& f, const std::string& name) {
    const int link = m.link(f.link);
    return {m.link_body[std::size_t(link)], placement(f.place, name), f.place.dh, {}};
  }

  void coordinates() {
    const double infinite = std::numeric_limits<double>::infinity();
    for (const NamedCoordinate& c : coordinates_of(m_d)) {
      m_coordinate.emplace(c.name, int(m.coordinates.size()));
      m.coordinates.push_back(c.name);
      m.measures.push_back(c.measure);
    }
    m.low.assign(m.coordinates.size(), -infinite);
    m.high.assign(m.coordinates.size(), infinite);
    m.start.assign(m.coordinates.size(), 0);
    m.offset_dimension.assign(m.coordinates.size(), -1);
  }
  void limit(int first, const std::vector<double>& limits, const std::vector<double>& start) {
    for (std::size_t k = 0; 2 * k + 1 < limits.size(); ++k) {
      m.low[std::size_t(first) + k] = limits[2 * k];
      m.high[std::size_t(first) + k] = limits[2 * k + 1];
    }
    for (std::size_t k = 0; k < start.size(); ++k) m.start[std::size_t(first) + k] = start[k];
  }

  void bodies() {
    m.bodies.push_back({});
    m.links.push_back("ground");
    m.link_body.push_back(0);
    for (const Link& l : m_d.links) m.links.push_back(l.name);
    m.link_body.resize(m.links.size(), -1);
    for (std::size_t left = m_d.links.size(); left > 0;)  // parents first, else as described
      for (std::size_t i = 0; i < m_d.links.size(); ++i) {
        const int parent = m.link_body[std::size_t(m.link(m_d.links[i].parent))];
        if (m.link_body[i + 1] >= 0 || parent < 0) continue;
        m.link_body[i + 1] = bodies_of(m_d.links[i], parent);
        --left;
      }
    int coordinate = 0;
    for (const Link& l : m_d.links) {
      limit(coordinate, l.joint.limits, l.joint.start);
      coordinate += int(freedoms(l.joint).size());
    }
    for (const Motor& motor : m_d.motors) limit(coordinate++, motor.limits, motor.start);
    for (std::size_t i = 0; i < m_d.links.size(); ++i) shapes(m_d.links[i], m.link_body[i + 1]);
  }

  /// @return the body that is the link; before it, one a freedom of its joint
  int bodies_of(const Link& l, int parent) {
    std::vector<Freedom> all = freedoms(l.joint);
    if (all.empty()) all.push_back({});
    for (std::size_t k = 0; k < all.size(); ++k) {
      Body b;
      b.parent = parent;
      b.motion = all[k].motion;
      b.axis = all[k].axis;
      if (b.motion != Motion::none) b.coordinate = m_coordinate.at(coordinate_name(l, all[k]));
      if (k == 0) {
        b.dimensions = placement(l.joint.place, l.name);
        b.dh = l.joint.place.dh;
      }
      if (k + 1 == all.size()) {
        b.mass = l.mass;
        b.centre = l.centre;
        const auto& [xx, yy, zz, xy, xz, yz] = l.inertia;
        b.inertia = {{{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}}};
      }
      parent = int(m.bodies.size());
      m.bodies.push_back(b);
    }
    return parent;
  }

  void shapes(const Link& l, int body) {
    for (std::size_t k = 0; k < l.shapes.size(); ++k) {
      const Shape& s = l.shapes[k];
      const std::string name = l.name + ".shape" + std::to_string(k + 1);
      BodyShape out;
      out.body = body;
      out.kind = s.kind;
      const bool box = s.kind == ShapeKind::box;
      out.dimensions = three(s.from, Measure::length, name + (box ? ".middle" : ".from"));
      three(s.to, Measure::length, name + (box ? ".edge" : ".to"));
      if (box)
        three(s.turn, Measure::angle, name + ".turn");
      else
        dimension(s.radius, Measure::length, name + ".radius");
      m.shapes.push_back(out);
    }
  }

  void couplings() {
    const int count = m.q_count();
    std::vector<std::vector<Mechanism::Share>> shares(std::size_t(count), std::vector<Mechanism::Share>{});
    std::vector<char> coupled(std::size_t(count), 0);
    int coordinate = 0;
    for (const Link& l : m_d.links) {
      if (l.joint.kind == JointKind::helical) {
        const int pitch = dimension(l.joint.pitch, Measure::length, l.name + ".pitch");
        shares[std::size_t(coordinate) + 1].push_back({coordinate, pitch, 1 / portable::two_pi});
        coupled[std::size_t(coordinate) + 1] = 1;
      }
      coordinate += int(freedoms(l.joint).size());
    }
    for (const Coupling& c : m_d.couplings) {
      const int of = m_coordinate.at(c.coordinate);
      coupled[std::size_t(of)] = 1;
      m.offset_dimension[std::size_t(of)] = dimension(c.offset, m.measures[std::size_t(of)], c.coordinate + ".offset");
      for (const Coupling::Term& t : c.terms)
        shares[std::size_t(of)].push_back(
            {m_coordinate.at(t.of), dimension(t.ratio, Measure::ratio, c.coordinate + ".ratio." + t.of), 1});
    }
    m.share_start.push_back(0);
    for (const std::vector<Mechanism::Share>& row : shares) {
      m.shares.insert(m.shares.end(), row.begin(), row.end());
      m.share_start.push_back(int(m.shares.size()));
    }
    for (int i = 0; i < count; ++i)
      if (!coupled[std::size_t(i)]) m.independent.push_back(i);
    order_dependents(coupled);
  }

  void order_dependents(const std::vector<char>& coupled) {
    const std::size_t count = coupled.size();
    std::vector<std::vector<int>> rows(count);
    for (std::size_t k = 0; k < m.independent.size(); ++k) rows[std::size_t(m.independent[k])].push_back(int(k));
    std::vector<char> done(count, 0);
    for (std::size_t i = 0; i < count; ++i) done[i] = !coupled[i];
    for (std::size_t round = 0; round < count; ++round)
      for (std::size_t i = 0; i < count; ++i) {
        if (done[i]) continue;
        const auto from = m.shares.begin() + m.share_start[i], to = m.shares.begin() + m.share_start[i + 1];
        if (!std::all_of(from, to, [&](const Mechanism::Share& s) { return done[std::size_t(s.of)] != 0; })) continue;
        for (auto s = from; s != to; ++s)
          for (const int u : rows[std::size_t(s->of)])
            if (std::find(rows[i].begin(), rows[i].end(), u) == rows[i].end()) rows[i].push_back(u);
        std::sort(rows[i].begin(), rows[i].end());
        done[i] = 1;
        m.dependents.push_back(int(i));
      }
    m.expand_start.push_back(0);
    for (const std::vector<int>& row : rows) {
      for (const int u : row) m.expand.push_back({u, 1});
      m.expand_start.push_back(int(m.expand.size()));
    }
    m.offset.assign(count, 0);
  }

  void actuator(const Actuator& a) {
    Drive d;
    d.name = a.name;
    const int coordinate = m_coordinate.at(a.coordinate);
    d.independent = m.independent_of(a.coordinate);
    const Measure measure = m.measures[std::size_t(coordinate)];
    d.dimensions = dimension(a.at_0, measure, a.name + ".at_0");
    dimension(a.at_1, measure, a.name + ".at_1");
    m.drives.push_back(d);
  }

  void closure(const LoopClosure& c) {
    Closure out;
    out.a = frame(c.a, c.name + ".a");
    out.b = frame(c.b, c.name + ".b");
    set_directions(out, c.directions);
    m.closure_names.push_back(c.name);
    m.closures.push_back(out);
    m.rows += out.count;
  }

  /// Whatever is large: a metre says nothing about an instrument of millimetres.
  void measure_length() {
    double largest = 0;
    for (const Frame& f : m.places) largest = std::max(largest, length(f.p));
    for (const Closure& c : m.closures)
      largest = std::max({largest, c.a.body ? length(c.a.local.p) : 0, c.b.body ? length(c.b.local.p) : 0});
    for (std::size_t i = 0; i < m.coordinates.size(); ++i) {
      const double travel = m.high[i] - m.low[i];
      if (m.measures[i] == Measure::length && std::isfinite(travel)) largest = std::max(largest, travel);
    }
    m.length = largest > 1e-9 ? largest : 1;
  }

  const MechanismDescription& m_d;
  Mechanism m;
  std::map<std::string, int> m_coordinate;
};

}  // namespace

Mechanism build(const MechanismDescription& description) {
  const std::vector<MechanismFault> faults = check(description);
  if (!faults.empty()) throw std::invalid_argument(description.name + ": " + faults.front().message);
  return Building(description).build();
}

}  // namespace trocar::kinematics

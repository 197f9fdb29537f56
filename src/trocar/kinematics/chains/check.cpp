// What keeps a description from being built.
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/kinematics/chains/joints.hpp>

namespace trocar::kinematics {
namespace {

using Part = MechanismFault::Part;

class Checking {
 public:
  explicit Checking(const MechanismDescription& d) : m_d(d), m_coordinates(coordinates_of(d)) {}

  std::vector<MechanismFault> check() {
    sizes();
    if (!m_faults.empty()) return std::move(m_faults);
    names();
    for (std::size_t i = 0; i < m_d.links.size(); ++i) link(int(i));
    for (std::size_t i = 0; i < m_d.motors.size(); ++i)
      values(Part::motor, int(i), m_d.motors[i].limits, m_d.motors[i].start, 1);
    couplings();
    actuators();
    for (std::size_t i = 0; i < m_d.frames.size(); ++i) known_link(Part::frame, int(i), "link", m_d.frames[i].link);
    for (std::size_t i = 0; i < m_d.closures.size(); ++i) {
      const LoopClosure& c = m_d.closures[i];
      ends(Part::closure, int(i), c.a, c.b);
      if (c.directions == 0 || c.directions > (kT | kR))
        tell(Part::closure, int(i), "directions", "expected at least one direction, got none");
    }
    for (std::size_t i = 0; i < m_d.springs.size(); ++i) ends(Part::spring, int(i), m_d.springs[i].a, m_d.springs[i].b);
    if (m_faults.empty()) circles();
    return std::move(m_faults);
  }

 private:
  void tell(Part part, int index, std::string field, std::string message, int item = -1) {
    m_faults.push_back({part, index, item, std::move(field), std::move(message)});
  }

  void sizes() {
    if (m_d.links.empty()) tell(Part::mechanism, 0, "links", "expected at least one link, got none");
    if (int(m_d.links.size()) > kMostLinks)
      tell(Part::mechanism, 0, "links", tr("expected at most {} links, got {}", kMostLinks, m_d.links.size()));
    if (int(m_coordinates.size()) > kMostCoordinates)
      tell(Part::mechanism, 0, "links",
           tr("expected at most {} coordinates, got {}", kMostCoordinates, m_coordinates.size()));
    if (int(m_d.closures.size()) > kMostClosures)
      tell(Part::mechanism, 0, "closures",
           tr("expected at most {} closures, got {}", kMostClosures, m_d.closures.size()));
  }

  template <class List>
  void once(Part part, const List& list, const char* what, const char* reserved = nullptr) {
    std::map<std::string, int> seen;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const std::string& name = list[i].name;
      if (reserved && name == reserved)
        tell(part, int(i), "name", tr("expected another name, as \"{}\" is the fixed frame's", name));
      if (!seen.emplace(name, int(i)).second)
        tell(part, int(i), "name", tr("expected every name of {} once, got \"{}\" again", what, name));
    }
  }

  void names() {
    once(Part::parameter, m_d.parameters, "a parameter");
    once(Part::link, m_d.links, "a link", "ground");
    once(Part::actuator, m_d.actuators, "an actuator");
    once(Part::frame, m_d.frames, "a frame");
    once(Part::closure, m_d.closures, "a closure");
    once(Part::spring, m_d.springs, "a spring");
    for (std::size_t i = 0; i < m_d.links.size(); ++i) m_link.emplace(m_d.links[i].name, int(i));
    for (std::size_t i = 0; i < m_coordinates.size(); ++i) {
      const NamedCoordinate& c = m_coordinates[i];
      if (!m_coordinate.emplace(c.name, int(i)).second)
        tell(c.link >= 0 ? Part::link : Part::motor, std::max(c.link, c.motor), "name",
             tr("expected every coordinate's name once, got \"{}\" again", c.name));
    }
  }

  std::string link_names() const {
    std::string all = "ground";
    for (std::size_t i = 0; i < std::min<std::size_t>(m_d.links.size(), 20); ++i) all += ", " + m_d.links[i].name;
    return all;
  }
  std::string coordinate_names() const {
    std::string all;
    for (std::size_t i = 0; i < std::min<std::size_t>(m_coordinates.size(), 20); ++i)
      all += (i ? ", " : "") + m_coordinates[i].name;
    return all;
  }
  bool known_link(Part part, int index, const char* field, const std::string& name) {
    if (name == "ground" || m_link.count(name)) return true;
    tell(part, index, field, tr("expected a link ({}), got \"{}\"", link_names(), name));
    return false;
  }
  int known_coordinate(Part part, int index, const char* field, const std::string& name, int item = -1) {
    const auto at = m_coordinate.find(name);
    if (at != m_coordinate.end()) return at->second;
    tell(part, index, field, tr("expected a coordinate ({}), got \"{}\"", coordinate_names(), name), item);
    return -1;
  }
  void ends(Part part, int index, const NamedFrame& a, const NamedFrame& b) {
    const bool known = known_link(part, index, "a", a.link) && known_link(part, index, "b", b.link);
    if (known && a.link == b.link)
      tell(part, index, "b", tr("expected another link than the first, got \"{}\" twice", a.link));
  }

  void values(Part part, int index, const std::vector<double>& limits, const std::vector<double>& start, int count) {
    if (!limits.empty() && int(limits.size()) != 2 * count)
      tell(part, index, "limits",
           tr("expected low and high of {} coordinate{}, got {} numbers", count, count == 1 ? "" : "s", limits.size()));
    else
      for (std::size_t k = 0; k + 1 < limits.size(); k += 2)
        if (!(limits[k] <= limits[k + 1])) tell(part, index, "limits", "expected low before high, got the reverse");
    if (!start.empty() && int(start.size()) != count)
      tell(part, index, "start", tr("expected {} number{}, got {}", count, count == 1 ? "" : "s", start.size()));
  }

  void link(int i) {
    const Link& l = m_d.links[std::size_t(i)];
    known_link(Part::link, i, "parent", l.parent);
    const Joint& j = l.joint;
    const int count = int(freedoms(j).size()) - (j.kind == JointKind::helical ? 1 : 0);
    values(Part::link, i, j.limits, j.start, count);
    if (!(length(j.axis) > 1e-6)) tell(Part::link, i, "axis", "expected a direction, got three zeros");
    const auto [xx, yy, zz, xy, xz, yz] = l.inertia;
    const double tolerance = 1e-9 * (xx + yy + zz);
    if (xx < 0 || yy < 0 || zz < 0 || xx + yy < zz - tolerance || yy + zz < xx - tolerance ||
        zz + xx < yy - tolerance || xy * xy > xx * yy + tolerance * tolerance ||
        xz * xz > xx * zz + tolerance * tolerance || yz * yz > yy * zz + tolerance * tolerance)
      tell(Part::link, i, "inertia", "expected the moments of a body (each at most the sum of the others), got others");
  }

  void couplings() {
    std::map<std::string, int> made;
    for (std::size_t i = 0; i < m_d.couplings.size(); ++i) {
      const Coupling& c = m_d.couplings[i];
      const int of = known_coordinate(Part::coupling, int(i), "coordinate", c.coordinate);
      if (of >= 0 && m_coordinates[std::size_t(of)].screwed)
        tell(Part::coupling, int(i), "coordinate",
             tr("expected a free coordinate, got \"{}\", which follows its screw's turn", c.coordinate));
      if (!made.emplace(c.coordinate, int(i)).second)
        tell(Part::coupling, int(i), "coordinate",
             tr("expected every coordinate coupled once, got \"{}\" again", c.coordinate));
      for (std::size_t k = 0; k < c.terms.size(); ++k)
        known_coordinate(Part::coupling, int(i), "of", c.terms[k].of, int(k));
    }
  }

  void actuators() {
    for (std::size_t i = 0; i < m_d.actuators.size(); ++i) {
      const std::string& name = m_d.actuators[i].coordinate;
      const int of = known_coordinate(Part::actuator, int(i), "coordinate", name);
      if (of < 0) continue;
      const bool coupled = std::any_of(m_d.couplings.begin(), m_d.couplings.end(),
                                       [&](const Coupling& c) { return c.coordinate == name; });
      if (coupled || m_coordinates[std::size_t(of)].screwed)
        tell(Part::actuator, int(i), "coordinate",
             tr("expected a free coordinate, got \"{}\", which follows others", name));
    }
  }

  /// Links that hang on themselves, coordinates that make themselves.
  void circles() {
    for (std::size_t i = 0; i < m_d.links.size(); ++i) {
      std::string at = m_d.links[i].parent;
      std::size_t steps = 0;
      for (; at != "ground" && steps <= m_d.links.size(); ++steps) at = m_d.links[std::size_t(m_link[at])].parent;
      if (at != "ground")
        tell(Part::link, int(i), "parent",
             tr("expected parents up to the ground, got a cycle through \"{}\"", m_d.links[i].name));
    }
    std::vector<std::vector<int>> needs(m_coordinates.size());
    for (std::size_t c = 0; c < m_coordinates.size(); ++c)
      if (m_coordinates[c].screwed) needs[c].push_back(int(c) - 1);
    for (const Coupling& c : m_d.couplings)
      for (const Coupling::Term& t : c.terms)
        needs[std::size_t(m_coordinate[c.coordinate])].push_back(m_coordinate[t.of]);
    std::vector<char> good(m_coordinates.size(), 0);
    for (std::size_t round = 0; round < m_coordinates.size(); ++round)
      for (std::size_t c = 0; c < needs.size(); ++c)
        good[c] =
            good[c] || std::all_of(needs[c].begin(), needs[c].end(), [&](int n) { return good[std::size_t(n)] != 0; });
    for (std::size_t i = 0; i < m_d.couplings.size(); ++i)
      if (!good[std::size_t(m_coordinate[m_d.couplings[i].coordinate])])
        tell(Part::coupling, int(i), "coordinate",
             tr("expected couplings that end at a free coordinate, got a cycle through \"{}\"",
                m_d.couplings[i].coordinate));
  }

  const MechanismDescription& m_d;
  std::vector<NamedCoordinate> m_coordinates;
  std::map<std::string, int> m_link, m_coordinate;
  std::vector<MechanismFault> m_faults;
};

}  // namespace

std::vector<MechanismFault> check(const MechanismDescription& description) { return Checking(description).check(); }

}  // namespace trocar::kinematics

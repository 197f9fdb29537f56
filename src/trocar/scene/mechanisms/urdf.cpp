#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/foreign/foreign_file.hpp>
#include <trocar/core/text.hpp>
#include <trocar/kinematics/chains/frame.hpp>
#include <trocar/scene/json/shape.hpp>
#include <trocar/scene/mechanisms/urdf.hpp>
#include <trocar/scene/mechanisms/xacro.hpp>

namespace trocar::scene {
namespace urdf_reading {
namespace {

using namespace kinematics;

constexpr double kMostOfAFile = 1e6;  // metres, radians, kilograms: beyond, nothing is meant

Quantities plain(Vec3d v) { return {Quantity{v.x}, Quantity{v.y}, Quantity{v.z}}; }

class Reading {
 public:
  Reading(const std::string& file, std::vector<core::Fault>& faults) : m_file(file), m_faults(faults) {}

  MechanismDescription read(const XmlElement& root) {
    const std::size_t before = m_faults.size();
    if (root.name != "robot") {
      fault(root, tr("expected a robot (URDF, <robot>), got {}", core::foreign_xml(root.name, core::Wanted::json)));
      return {};
    }
    if (tell_of_xacro(root, m_file, m_faults)) return {};  // what else is wrong may follow from that
    if (const XmlAttribute* a = root.attribute("name")) d.name = a->value;
    if (is_too_large_or_no_robot(root)) return {};
    for (const XmlElement& e : root.children)
      if (e.name == "link") link(e);
    for (const XmlElement& e : root.children)
      if (e.name == "joint") joint(e);
    if (m_faults.size() == before) roots();
    actuators();
    if (m_faults.size() == before)
      for (const MechanismFault& f : check(d)) fault(place_of(f, root), f.message);
    return std::move(d);
  }

 private:
  void fault(const XmlElement& e, std::string message) {
    tell(m_faults, {{m_file, e.line, e.column}, std::move(message)});
  }
  void fault(const XmlAttribute& a, std::string message) {
    tell(m_faults, {{m_file, a.line, a.column}, std::move(message)});
  }

  /// Whatever is missing of a robot that is not read to its end is no fault of its file.
  bool is_too_large_or_no_robot(const XmlElement& root) {
    const auto count = [&root](auto&&... names) {
      return std::count_if(root.children.begin(), root.children.end(),
                           [&](const XmlElement& e) { return ((e.name == names) || ...); });
    };
    const auto links = count("link");
    if (links > kMostLinks) {
      fault(root, tr("expected at most {} links, got {}: leave out those that are fixed to others", kMostLinks, links));
    } else if (links == 0) {
      const bool semantic = count("group", "group_state", "disable_collisions", "end_effector", "virtual_joint") > 0;
      fault(root, semantic ? tr("expected a robot (URDF), got a robot's groups and poses (SRDF): open its URDF instead")
                           : tr("expected at least one <link>, got none"));
    }
    return links == 0 || links > kMostLinks;
  }

  const XmlElement& place_of(const MechanismFault& f, const XmlElement& root) const {
    using Part = MechanismFault::Part;
    const auto i = std::size_t(f.index);
    if (f.part == Part::link && i < m_link_at.size()) return m_joint_of[i] ? *m_joint_of[i] : *m_link_at[i];
    if (f.part == Part::coupling && i < m_mimic_at.size()) return *m_mimic_at[i];
    return root;
  }

  /// Numbers with spaces between. @return false, and a fault, where there are others than `count` of them
  bool numbers(const XmlElement& e, const char* name, double* out, int count, bool needed) {
    const XmlAttribute* a = e.attribute(name);
    if (!a) {
      if (needed) fault(e, tr("expected \"{}\" of <{}>, got none", name, e.name));
      return false;
    }
    std::vector<double> values;
    for (std::size_t at = 0; at < a->value.size();) {
      const std::size_t from = a->value.find_first_not_of(' ', at);
      if (from == std::string::npos) break;
      at = std::min(a->value.find(' ', from), a->value.size());
      const std::string word = a->value.substr(from, at - from);
      if (!core::is_decimal(word) || !(std::fabs(core::to_double(word)) <= kMostOfAFile)) {
        fault(*a, tr("expected a number of at most {} either way, got \"{}\"", kMostOfAFile, word.substr(0, 40)));
        return false;
      }
      if (int(values.size()) <= count) values.push_back(core::to_double(word));
    }
    if (int(values.size()) != count) {
      fault(*a, tr("expected {} number{}, got {}", count, count == 1 ? "" : "s",
                   int(values.size()) > count ? "more" : fmt::format("{}", values.size())));
      return false;
    }
    std::copy(values.begin(), values.end(), out);
    return true;
  }
  Vec3d vec3(const XmlElement& e, const char* name, Vec3d fallback = {}, bool needed = false) {
    double v[3];
    return numbers(e, name, v, 3, needed) ? Vec3d{v[0], v[1], v[2]} : fallback;
  }
  double number(const XmlElement& e, const char* name, double fallback, bool needed = false) {
    double v;
    return numbers(e, name, &v, 1, needed) ? v : fallback;
  }
  struct Origin {
    Vec3d xyz, rpy;
    Frame frame() const { return {turn_xyz(rpy), xyz}; }
  };
  Origin origin(const XmlElement& e) {
    const XmlElement* o = e.child("origin");
    return o ? Origin{vec3(*o, "xyz"), vec3(*o, "rpy")} : Origin{};
  }
  std::string text(const XmlElement& e, const char* name) {
    const XmlAttribute* a = e.attribute(name);
    if (a && !a->value.empty()) return a->value;
    fault(e, tr("expected \"{}\" of <{}>, got none", name, e.name));
    return {};
  }

  void link(const XmlElement& e) {
    Link l;
    l.name = text(e, "name");
    if (!m_link.emplace(l.name, int(d.links.size())).second)
      return fault(e, tr("expected every link once, got \"{}\" again", l.name));
    if (const XmlElement* i = e.child("inertial")) inertial(*i, l);
    bool collides = false;  // shapes for contact are simpler, where a file has both
    for (const XmlElement& c : e.children) collides = collides || c.name == "collision";
    for (const XmlElement& c : e.children)
      if (c.name == (collides ? "collision" : "visual")) shape(c, l);
    d.links.push_back(std::move(l));
    m_link_at.push_back(&e);
    m_joint_of.push_back(nullptr);
  }

  void inertial(const XmlElement& e, Link& l) {
    const Origin at = origin(e);
    l.centre = at.xyz;
    if (const XmlElement* m = e.child("mass")) {
      l.mass = number(*m, "value", 0, true);
      if (l.mass < 0) fault(*m, tr("expected a mass of at least 0, got {}", l.mass));
    }
    if (const XmlElement* i = e.child("inertia")) {
      const double xx = number(*i, "ixx", 0), yy = number(*i, "iyy", 0), zz = number(*i, "izz", 0);
      const double xy = number(*i, "ixy", 0), xz = number(*i, "ixz", 0), yz = number(*i, "iyz", 0);
      const Mat3d r = turn_xyz(at.rpy), m = r * Mat3d{{{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}}} * transposed(r);
      l.inertia = {m.m[0][0], m.m[1][1], m.m[2][2], m.m[0][1], m.m[0][2], m.m[1][2]};
    }
  }

  void shape(const XmlElement& e, Link& l) {
    constexpr std::size_t kMostShapes = 200;
    const XmlElement* geometry = e.child("geometry");
    if (!geometry || l.shapes.size() >= kMostShapes) return;
    const Origin at = origin(e);
    const auto rod = [&](ShapeKind kind, double half, double radius) {
      kinematics::Shape s;
      s.kind = kind;
      s.from = plain(at.frame() * Vec3d{0, 0, -half});
      s.to = plain(at.frame() * Vec3d{0, 0, half});
      s.radius = {radius};
      l.shapes.push_back(std::move(s));
    };
    if (const XmlElement* c = geometry->child("cylinder"))
      rod(ShapeKind::cylinder, 0.5 * number(*c, "length", 0, true), number(*c, "radius", 0, true));
    if (const XmlElement* s = geometry->child("sphere")) rod(ShapeKind::capsule, 0, number(*s, "radius", 0, true));
    if (const XmlElement* b = geometry->child("box")) {
      kinematics::Shape s;
      s.kind = ShapeKind::box;
      s.from = plain(at.xyz);
      s.to = plain(vec3(*b, "size", {}, true));
      s.turn = plain(at.rpy);
      l.shapes.push_back(std::move(s));
    }
  }

  int named_link(const XmlElement& joint, const char* which) {
    const XmlElement* e = joint.child(which);
    if (!e) {
      fault(joint, tr("expected <{}> of the joint, got none", which));
      return -1;
    }
    const std::string name = text(*e, "link");
    const auto found = m_link.find(name);
    if (found != m_link.end()) return found->second;
    std::vector<std::string> known;
    for (const Link& l : d.links)
      if (known.size() < 50) known.push_back(l.name);
    if (!name.empty()) fault(*e, unknown_name("link", name, known));
    return -1;
  }

  void joint(const XmlElement& e) {
    const std::string name = text(e, "name"), type = text(e, "type");
    const auto [first, is_new] = m_joint.emplace(name, e.line);
    if (!is_new && !name.empty())
      return fault(e, tr("expected every joint once, got \"{}\" again (first in line {})", name, first->second));
    const int parent = named_link(e, "parent"), child = named_link(e, "child");
    if (parent < 0 || child < 0) return;
    Link& l = d.links[std::size_t(child)];
    if (m_joint_of[std::size_t(child)])
      return fault(e, tr("expected one joint to each link, got a second one to \"{}\" (first in line {})", l.name,
                         m_joint_of[std::size_t(child)]->line));
    m_joint_of[std::size_t(child)] = &e;
    l.parent = d.links[std::size_t(parent)].name;
    Joint& j = l.joint;
    j.name = name;
    const Origin at = origin(e);
    j.place.at = plain(at.xyz);
    j.place.turn = plain(at.rpy);
    if (type == "fixed") return;
    if (type == "prismatic")
      j.kind = JointKind::prismatic;
    else if (type == "revolute" || type == "continuous")
      j.kind = JointKind::revolute;
    else if (!type.empty())
      return fault(*e.attribute("type"),
                   tr("expected revolute, continuous, prismatic or fixed, got \"{}\"", type.substr(0, 40)));
    j.axis = {1, 0, 0};
    if (const XmlElement* axis = e.child("axis")) {
      j.axis = vec3(*axis, "xyz", j.axis);
      if (!(length(j.axis) > 1e-6)) fault(*axis, "expected a direction, got three zeros");
    }
    const XmlElement* limit = e.child("limit");
    if (limit && type != "continuous") {
      j.limits = {number(*limit, "lower", 0), number(*limit, "upper", 0)};
      j.start = {j.limits[0] > 0 || j.limits[1] < 0 ? 0.5 * (j.limits[0] + j.limits[1]) : 0};
    }
    if (const XmlElement* mimic = e.child("mimic")) {
      Coupling c;
      c.coordinate = name;
      c.offset = {number(*mimic, "offset", 0)};
      c.terms = {{text(*mimic, "joint"), {number(*mimic, "multiplier", 1)}}};
      d.couplings.push_back(std::move(c));
      m_mimic_at.push_back(mimic);
    }
  }

  /// A robot is one tree; a second root means that a joint is missing, or that a link was misspelt.
  void roots() {
    const auto has_children = [this](const Link& l) {
      return std::any_of(d.links.begin(), d.links.end(), [&l](const Link& other) { return other.parent == l.name; });
    };
    int root = -1;
    for (std::size_t i = 0; i < d.links.size(); ++i)
      if (!m_joint_of[i] && (root < 0 || (has_children(d.links[i]) && !has_children(d.links[std::size_t(root)]))))
        root = int(i);
    for (std::size_t i = 0; i < d.links.size(); ++i)
      if (!m_joint_of[i] && int(i) != root)
        fault(*m_link_at[i], tr("expected a joint to every link but the root \"{}\", got none to \"{}\"",
                                d.links[std::size_t(root)].name, d.links[i].name));
  }

  void actuators() {
    for (const Link& l : d.links) {
      if (l.joint.kind == JointKind::fixed || int(d.actuators.size()) > kMostCoordinates) continue;
      bool follows = false;
      for (const Coupling& c : d.couplings) follows = follows || c.coordinate == l.joint.name;
      if (follows) continue;
      const bool limited = l.joint.limits.size() == 2;
      const double turn = l.joint.kind == JointKind::revolute ? portable::pi : 0.1;
      d.actuators.push_back(
          {l.joint.name, l.joint.name, {limited ? l.joint.limits[0] : -turn}, {limited ? l.joint.limits[1] : turn}});
    }
  }

  const std::string& m_file;
  std::vector<core::Fault>& m_faults;
  MechanismDescription d;
  std::map<std::string, int> m_link;   ///< their numbers
  std::map<std::string, int> m_joint;  ///< their lines
  std::vector<const XmlElement*> m_link_at, m_joint_of, m_mimic_at;
};

}  // namespace
}  // namespace urdf_reading

kinematics::MechanismDescription read_urdf(std::string_view text, const std::string& file,
                                           std::vector<core::Fault>& faults) {
  const std::size_t before = faults.size();
  const XmlElement root = parse_xml(text, file, faults);
  if (faults.size() != before) return {};
  return urdf_reading::Reading(file, faults).read(root);
}

}  // namespace trocar::scene

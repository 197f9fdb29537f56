#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <trocar/scene/files/reader_parts.hpp>
#include <trocar/scene/files/vessel_file.hpp>

namespace trocar::scene {

namespace {

using vessels::GraphFault;

constexpr double kMeet = 0.005;     // [m] within which paths meet at a node
constexpr double kTortuous = 0.95;  // a vessel's length is no less than this share of its path's

double from_mmhg(double p) { return p * vessels::kPascalPerMmHg; }
double from_resistance(double r) { return r * (vessels::kPascalPerMmHg * 1e6); }  // mmHg s/mL
double from_ml_min(double q) { return q / 60e6; }

/// A key of a file for a field of the graph.
struct KeyOf {
  const char* field;
  const char* key;
};
constexpr KeyOf kKeys[] = {{"length", "length_mm"},         {"radius", "radius_mm"},
                           {"radius_to", "radius_to_mm"},   {"wall.wave_speed", "wave_speed_m_s"},
                           {"wall.modulus", "modulus_kPa"}, {"wall.thickness", "thickness_mm"},
                           {"wall.poisson", "poisson"},     {"r_near", "near_mmHg_s_mL"},
                           {"r_far", "far_mmHg_s_mL"},      {"compliance", "compliance_mL_mmHg"},
                           {"pressure", "pressure_mmHg"},   {"resistance", "resistance_mmHg_s_mL"},
                           {"rate", "rate_per_min"},        {"systolic", "systolic_mmHg"},
                           {"diastolic", "diastolic_mmHg"}, {"breaths", "breaths_per_min"},
                           {"segments", "vessels"},         {"volume", "blood_L"}};
std::string key_of(const std::string& field) {
  for (const KeyOf& k : kKeys)
    if (field == k.field) return k.key;
  return field;
}

/// One file.
class VesselReading {
 public:
  VesselReading(const JsonObject& file, std::vector<core::Fault>& faults) : m_file(file), m_faults(faults) {}

  VesselTree read() {
    const std::size_t before = m_faults.size();
    m_tree.name = m_file.text("name");
    m_tree.at = m_file.at();
    m_tree.text = m_file.value();
    m_tree.pulse_gain = m_file.number("pulse_gain", 1);
    m_tree.says_heart = m_file.names("heart") || m_file.names("blood_L");
    m_tree.heart_at = m_file.at(m_file.names("heart") ? "heart" : "blood_L");
    m_tree.graph.tree = m_file.flag("tree");
    m_tree.graph.blood.volume = m_file.number("blood_L", 5) / 1000;
    heart();
    m_vessels = m_file.objects("vessels");
    for (const JsonObject& o : m_vessels) vessel(o);
    m_tree.graph.nodes = int(m_tree.nodes.size());
    check_names();
    check_meetings();
    m_sources = m_file.objects("sources");
    for (const JsonObject& o : m_sources) source(o);
    m_ends = m_file.objects("ends");
    const bool sound = m_faults.size() == before;
    for (const JsonObject& o : m_ends) end(o, sound);
    if (m_faults.size() == before) check_graph();
    return std::move(m_tree);
  }

 private:
  void heart() {
    vessels::Heart& h = m_tree.graph.heart;
    for (const JsonObject& o : m_file.objects("heart")) {
      m_heart = o;
      h.rate = o.number("rate_per_min", h.rate);
      h.breaths = o.number("breaths_per_min", h.breaths);
      if (o.has("systolic_mmHg")) h.systolic = from_mmhg(o.number("systolic_mmHg"));
      if (o.has("diastolic_mmHg")) h.diastolic = from_mmhg(o.number("diastolic_mmHg"));
      if (o.has("arterial_swing_mmHg")) h.arterial_swing = from_mmhg(o.number("arterial_swing_mmHg"));
      if (o.has("venous_swing_mmHg")) h.venous_swing = from_mmhg(o.number("venous_swing_mmHg"));
    }
  }

  int node(const std::string& name) {
    if (name.empty()) return -1;
    const auto [at, fresh] = m_node.try_emplace(name, int(m_tree.nodes.size()));
    if (fresh) m_tree.nodes.push_back(name);
    return at->second;
  }
  int known_node(const JsonObject& o) {
    const std::string name = o.text("node");
    const auto at = m_node.find(name);
    if (at != m_node.end()) return at->second;
    if (o.has("node")) o.fault("node", unknown_name("node", name, some_nodes()));
    return -1;
  }
  /// Enough to guess what was meant; not 20,000.
  std::vector<std::string> some_nodes() const {
    constexpr std::size_t kMost = 200;
    return {m_tree.nodes.begin(), m_tree.nodes.begin() + std::ptrdiff_t(std::min(kMost, m_tree.nodes.size()))};
  }

  void vessel(const JsonObject& o) {
    Vessel v;
    v.name = o.text("name");
    v.path = from_mm(o.points("path_mm"));
    v.rides_on = o.texts("rides_on");
    for (std::size_t i = 0; i < v.rides_on.size(); ++i) v.rides_at.push_back(o.at("rides_on", i));
    v.reach = from_mm(o.number("reach_mm", 4));
    v.at = o.at();
    vessels::VesselSegment s;
    s.from = node(o.text("from"));
    s.to = node(o.text("to"));
    const double path = curve_length(v.path);
    s.length = o.has("length_mm") ? from_mm(o.number("length_mm")) : path;
    if (o.has("length_mm") && o.has("path_mm") && s.length < kTortuous * path)
      o.fault("length_mm",
              fmt::format("expected at least its path's length, {:.4g} mm, got {:.4g}", 1e3 * path, 1e3 * s.length));
    s.radius = from_mm(o.number("radius_mm"));
    s.radius_to = from_mm(o.number("radius_to_mm", 0));
    wall(o, s.wall);
    s.loss = o.number("loss", 0);
    s.vein = m_file.text("kind") == "veins";
    m_tree.graph.segments.push_back(s);
    m_tree.vessels.push_back(std::move(v));
  }

  static void wall(const JsonObject& o, vessels::VesselWall& w) {
    w.wave_speed = o.number("wave_speed_m_s", 0);
    w.modulus = 1e3 * o.number("modulus_kPa", 0);
    w.thickness = from_mm(o.number("thickness_mm", 0));
    w.poisson = o.number("poisson", 0);
    const bool both = o.names("modulus_kPa") && o.names("thickness_mm");
    const bool any = o.names("modulus_kPa") || o.names("thickness_mm") || o.names("poisson");
    if (o.names("wave_speed_m_s") ? any : !both)
      o.fault(o.at(), fmt::format("expected either \"wave_speed_m_s\" or \"modulus_kPa\" and \"thickness_mm\", got {}",
                                  o.names("wave_speed_m_s") ? "both" : (any ? "one of the two" : "none")));
  }

  void source(const JsonObject& o) {
    vessels::VesselSource s;
    s.node = known_node(o);
    const bool steady = o.text("kind", "heart") == "steady";
    s.kind = steady ? vessels::VesselSource::Kind::steady : vessels::VesselSource::Kind::heart;
    s.pressure = steady ? from_mmhg(o.number("pressure_mmHg", 93)) : 0;
    if (!steady && o.has("pressure_mmHg"))
      o.fault("pressure_mmHg", "expected a pressure of a steady source only, as the heart has its own, got one");
    s.resistance = from_resistance(o.number("resistance_mmHg_s_mL", 0));
    s.venous = o.flag("venous");
    m_tree.graph.sources.push_back(s);
  }

  /// @param sound  without faults so far: a flow can be matched to the vessel that brings it
  void end(const JsonObject& o, bool sound) {
    vessels::VesselEnd e;
    e.node = known_node(o);
    e.r_near = from_resistance(o.number("near_mmHg_s_mL", 0));
    e.r_far = from_resistance(o.number("far_mmHg_s_mL", 0));
    e.compliance = o.number("compliance_mL_mmHg", 0) / (vessels::kPascalPerMmHg * 1e6);
    e.pressure = from_mmhg(o.number("pressure_mmHg", 5));
    const bool resists = o.names("near_mmHg_s_mL") || o.names("far_mmHg_s_mL");
    if (o.names("flow_mL_min") == resists)
      o.fault(o.at(), fmt::format("expected either \"flow_mL_min\" or resistances, got {}", resists ? "both" : "none"));
    if (sound && e.node >= 0 && o.has("flow_mL_min")) matched(o, e);
    m_tree.graph.ends.push_back(e);
  }

  void matched(const JsonObject& o, vessels::VesselEnd& e) {
    const auto& segments = m_tree.graph.segments;
    const auto brings = [&](const vessels::VesselSegment& s) { return s.to == e.node; };
    const auto it = std::find_if(segments.begin(), segments.end(), brings);
    if (it == segments.end())
      return o.fault("node", fmt::format("expected a node that a vessel leads to, got \"{}\"", o.text("node")));
    const double beyond = e.pressure, at = from_mmhg(o.number("at_mmHg", 90));
    if (at <= beyond)
      return o.fault(o.at("at_mmHg"), "expected a pressure above that beyond the end, got one that is not");
    const double usual = vessels::VesselEnd{}.pressure;  // matched_end() counts from there
    e = vessels::matched_end(m_tree.graph, int(it - segments.begin()), at - beyond + usual,
                             from_ml_min(o.number("flow_mL_min")), o.number("time_s", 1));
    e.pressure = beyond;
  }

  void check_names() {
    std::map<std::string, core::Location> seen;
    for (const Vessel& v : m_tree.vessels) {
      const auto [first, fresh] = seen.try_emplace(v.name, v.at);
      if (!fresh && !v.name.empty())
        tell(m_faults, {v.at, fmt::format("expected every vessel name once, got \"{}\" again (first in line {})",
                                          v.name, first->second.line)});
    }
  }

  /// All paths that begin or end at a node do so in one place.
  void check_meetings() {
    std::vector<std::optional<Vec3d>> place(m_tree.nodes.size());
    for (std::size_t i = 0; i < m_tree.vessels.size(); ++i) {
      const Vessel& v = m_tree.vessels[i];
      const vessels::VesselSegment& s = m_tree.graph.segments[i];
      if (v.path.size() < 2) continue;
      for (const auto& [node, point] : {std::pair{s.from, v.path.front()}, std::pair{s.to, v.path.back()}}) {
        if (node < 0) continue;
        std::optional<Vec3d>& first = place[std::size_t(node)];
        if (!first) first = point;
        if (!(length(point - *first) <= kMeet))
          m_vessels[i].fault("path_mm",
                             fmt::format("expected it to meet the others at node \"{}\" within {} mm, got "
                                         "{:.4g} mm between them",
                                         m_tree.nodes[std::size_t(node)], 1e3 * kMeet, 1e3 * length(point - *first)));
      }
    }
  }

  void check_graph() {
    for (const GraphFault& f : vessels::check(m_tree.graph)) tell(m_faults, {place_of(f), named(f.message)});
  }

  core::Location place_of(const GraphFault& f) const {
    const auto in = [&](const std::vector<JsonObject>& objects) {
      const bool there = f.index >= 0 && std::size_t(f.index) < objects.size();
      return there ? objects[std::size_t(f.index)].at(key_of(f.field)) : m_file.at();
    };
    switch (f.part) {
      case GraphFault::Part::segment:
        return in(m_vessels);
      case GraphFault::Part::end:
        return in(m_ends);
      case GraphFault::Part::source:
        return in(m_sources);
      case GraphFault::Part::heart:
        return m_heart ? m_heart->at(key_of(f.field)) : m_file.at();
      default:
        return m_file.at(key_of(f.field));
    }
  }

  /// The graph numbers its nodes; people have named them.
  std::string named(std::string message) const {
    static const std::string word = "node ";
    const std::size_t at = message.find(word), from = at + word.size();
    if (at == std::string::npos) return message;
    std::size_t to = from, number = 0;
    for (; to < message.size() && message[to] >= '0' && message[to] <= '9'; ++to)
      number = 10 * number + std::size_t(message[to] - '0');
    if (to == from || number >= m_tree.nodes.size()) return message;
    return message.replace(from, to - from, "\"" + m_tree.nodes[number] + "\"");
  }

  const JsonObject& m_file;
  std::vector<core::Fault>& m_faults;
  VesselTree m_tree;
  std::map<std::string, int> m_node;
  std::vector<JsonObject> m_vessels, m_ends, m_sources;
  std::optional<JsonObject> m_heart;
};

}  // namespace

VesselTree read_vessels(const std::filesystem::path& path, std::vector<core::Fault>& faults,
                        const MemoryFiles* memory) {
  const JsonDocument document = load_json(path, faults, memory);
  return read_vessels(JsonObject(document.root, vessels_shape(), document.file, faults), faults);
}

VesselTree read_vessels(const JsonObject& file, std::vector<core::Fault>& faults) {
  return VesselReading(file, faults).read();
}

VesselTree read_vessels(const std::filesystem::path& path, const MemoryFiles* memory) {
  std::vector<core::Fault> faults;
  VesselTree tree = read_vessels(path, faults, memory);
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  return tree;
}

}  // namespace trocar::scene

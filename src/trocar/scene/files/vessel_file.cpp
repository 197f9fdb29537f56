#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/scene/files/keys.hpp>
#include <trocar/scene/files/vessel_file.hpp>
#include <trocar/scene/files/vessel_keys.hpp>

namespace trocar::scene {

namespace {

using vessels::GraphFault;

constexpr double kMeet = 0.005;     // [m] within which paths meet at a node
constexpr double kTortuous = 0.95;  // a vessel's length is no less than this share of its path's

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
    vessel_file_keys().read(m_file, m_tree, m_context);
    m_tree.text = m_file.value();
    m_tree.says_heart = m_file.names("heart") || m_file.names("blood_L");
    m_tree.heart_at = m_file.at(m_file.names("heart") ? "heart" : "blood_L");
    for (const JsonObject& o : m_file.objects("heart")) heart().read(m_heart.emplace(o), m_tree.graph.heart, m_context);
    m_vessels = m_file.objects("vessels");
    for (const JsonObject& o : m_vessels) add_vessel(o);
    m_tree.graph.nodes = int(m_tree.nodes.size());
    check_names();
    check_meetings();
    m_sources = m_file.objects("sources");
    for (const JsonObject& o : m_sources) add_source(o);
    m_ends = m_file.objects("ends");
    const bool sound = m_faults.size() == before;
    for (const JsonObject& o : m_ends) add_end(o, sound);
    if (m_faults.size() == before) check_graph();
    return std::move(m_tree);
  }

 private:
  int node(const std::string& name) {
    if (name.empty()) return -1;
    const auto [at, fresh] = m_node.try_emplace(name, int(m_tree.nodes.size()));
    if (fresh) m_tree.nodes.push_back(name);
    return at->second;
  }
  int known_node(const JsonObject& o, const std::string& name) {
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

  void add_vessel(const JsonObject& o) {
    VesselLine line = vessel().made(o, m_context);
    line.from = node(line.from_node);
    line.to = node(line.to_node);
    const double path = curve_length(line.path);
    if (!o.has("length_mm")) line.length = path;
    if (o.has("length_mm") && o.has("path_mm") && line.length < kTortuous * path)
      o.fault("length_mm",
              tr("expected at least its path's length, {:.4g} mm, got {:.4g}", 1e3 * path, 1e3 * line.length));
    line.vein = m_file.text("kind") == "veins";
    m_tree.graph.segments.push_back(line);
    m_tree.vessels.push_back(std::move(line));
  }

  void add_source(const JsonObject& o) {
    SourceLine line = vessel_source().made(o, m_context);
    line.node = known_node(o, line.name_of_node);
    m_tree.graph.sources.push_back(line);
  }

  /// @param sound  without faults so far: a flow can be matched to the vessel that brings it
  void add_end(const JsonObject& o, bool sound) {
    EndLine line = vessel_end().made(o, m_context);
    line.node = known_node(o, line.name_of_node);
    if (sound && line.node >= 0 && o.has("flow_mL_min")) match(o, line);
    m_tree.graph.ends.push_back(line);
  }

  void match(const JsonObject& o, EndLine& line) {
    const auto& segments = m_tree.graph.segments;
    const auto brings = [&](const vessels::VesselSegment& s) { return s.to == line.node; };
    const auto it = std::find_if(segments.begin(), segments.end(), brings);
    if (it == segments.end())
      return o.fault("node", tr("expected a node that a vessel leads to, got \"{}\"", line.name_of_node));
    const double beyond = line.pressure;
    if (line.flow_pressure <= beyond)
      return o.fault(o.at("at_mmHg"), "expected a pressure above that beyond the end, got one that is not");
    const double usual = vessels::VesselEnd{}.pressure;  // matched_end() counts from there
    static_cast<vessels::VesselEnd&>(line) = vessels::matched_end(
        m_tree.graph, int(it - segments.begin()), line.flow_pressure - beyond + usual, line.flow, line.time);
    line.pressure = beyond;
  }

  void check_names() {
    std::map<std::string, core::Location> seen;
    for (const Vessel& v : m_tree.vessels) {
      const auto [first, fresh] = seen.try_emplace(v.name, v.at);
      if (!fresh && !v.name.empty())
        tell(m_faults, {v.at, tr("expected every vessel name once, got \"{}\" again (first in line {})", v.name,
                                 first->second.line)});
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
          m_vessels[i].fault("path_mm", tr("expected it to meet the others at node \"{}\" within {} mm, got "
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
  std::vector<Reference> m_references;  // none: a file alone knows no bodies
  Context m_context{{}, nullptr, m_references};
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

const Shape& vessels_shape() { return vessel_file_keys(); }

JsonValue written_vessels(const VesselTree& tree) {
  JsonValue o = tree.text;
  for (JsonMember& member : o.members) {
    if (member.key != "vessels") continue;
    for (std::size_t i = 0; i < member.value.items.size() && i < tree.vessels.size(); ++i) {
      const JsonValue now = vessel().written({tree.vessels[i], tree.graph.segments[i], {}, {}});
      for (JsonMember& key : member.value.items[i].members)
        if (key.key == "path_mm" || key.key == "length_mm") key.value = now.find(key.key)->value;
    }
  }
  return o;
}

}  // namespace trocar::scene

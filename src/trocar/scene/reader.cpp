#include <algorithm>
#include <cmath>
#include <system_error>

#include <fmt/format.h>

#include <trocar/numerics/portable.hpp>
#include <trocar/scene/capacity.hpp>
#include <trocar/scene/reader.hpp>

namespace trocar::scene {
namespace {

namespace fs = std::filesystem;
using core::Location;

constexpr double kMaxSolidNodes = 60'000;  // ten of today's organs: a tick of more is far from real time
constexpr double kMaxStrandNodes = 5'000;
constexpr double kMaxTriangles = 500'000;
constexpr int kMaxFiles = 256;
constexpr std::size_t kMaxIncludeDepth = 16;

// Dividing (not multiplying by 0.001) makes "1.5" mm the number nearest to 0.0015 m.
double from_mm(double v) { return v / 1000; }
Vec3d from_mm(Vec3d v) { return v / 1000.0; }
double from_deg(double v) { return v * portable::pi / 180; }

std::vector<Vec3d> from_mm(std::vector<Vec3d> points) {
  for (Vec3d& p : points) p = from_mm(p);
  return points;
}

/// A name that must belong to something by the time all files are read.
struct Reference {
  enum class To { tissue, solid, strand, solid_or_strand, port, instrument };
  To to;
  std::string name;
  Location at;
};

const char* noun(Reference::To to) {
  switch (to) {
    case Reference::To::tissue:
      return "tissue";
    case Reference::To::solid:
      return "solid";
    case Reference::To::strand:
      return "strand";
    case Reference::To::solid_or_strand:
      return "solid or strand";
    case Reference::To::port:
      return "port";
    case Reference::To::instrument:
      return "instrument";
  }
  return "";
}

template <class T>
void add_names(const std::vector<T>& things, std::vector<std::string>& names) {
  for (const T& thing : things)
    if (!thing.name.empty()) names.push_back(thing.name);
}

double area(const Section& s) {
  // of a super-ellipse: pi a b at exponent 2, towards 4 a b for a square (1 % good between)
  return (4 - 1.717 / s.squareness) * length(cross(s.across, s.deep));
}

/// Length of the Catmull-Rom curve through the points: within a few per cent of any smooth curve through them.
double curve_length(const std::vector<Vec3d>& p) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    const Vec3d a = p[i == 0 ? 0 : i - 1], b = p[i], c = p[i + 1], d = p[std::min(i + 2, p.size() - 1)];
    Vec3d last = b;
    constexpr int pieces = 8;
    for (int k = 1; k <= pieces; ++k) {
      const double t = double(k) / pieces;
      const Vec3d x = 0.5 * (2.0 * b + t * (c - a) + t * t * (2.0 * a - 5.0 * b + 4.0 * c - d) +
                             t * t * t * (3.0 * b - a - 3.0 * c + d));
      sum += length(x - last);
      last = x;
    }
  }
  return sum;
}

/// One pass over a scene and its files. Documents live here: objects point into them.
class Reading {
 public:
  explicit Reading(std::vector<core::Fault>& faults, const MemoryFiles* memory = nullptr)
      : m_faults(faults), m_memory(memory) {}

  Description description;

  void scene_file(const fs::path& path) {
    include(path, {path.generic_string(), 0, 0}, scene_shape(),
            [this](const JsonObject& o, const fs::path& folder) { scene(o, folder); });
  }
  void organ_file(const fs::path& path) {
    include(path, {path.generic_string(), 0, 0}, organ_shape(),
            [this](const JsonObject& o, const fs::path& folder) { organ(o, folder); });
  }
  void instrument_file(const fs::path& path) {
    include(path, {path.generic_string(), 0, 0}, instrument_shape(),
            [this](const JsonObject& o, const fs::path&) { instrument(o); });
  }
  void tissue_file(const fs::path& path) {
    include(path, {path.generic_string(), 0, 0}, tissue_shape(), [this](const JsonObject& o, const fs::path&) {
      for (const JsonObject& row : o.objects("tissues")) tissue(row);
    });
  }

  /// Every name that something refers to must be known by now.
  void resolve() {
    if (crowded()) return;
    for (const Reference& reference : m_references) {
      const std::vector<std::string> known = names(reference.to);
      if (std::find(known.begin(), known.end(), reference.name) == known.end())
        tell(m_faults, {reference.at, unknown_name(noun(reference.to), reference.name, known)});
    }
  }

  /// What needs several things to be known.
  void check_together() {
    if (crowded()) return;
    if (m_faults.empty()) check_capacity(description, m_faults);
    check_names();
    for (const Placement& tool : m_tools) check_tool(tool);
    for (const SheetEnd& sheet : m_sheet_ends) check_sheet(sheet);
  }

 private:
  std::vector<core::Fault>& m_faults;
  const MemoryFiles* m_memory;  ///< where not null, files are looked up there
  std::vector<Reference> m_references;
  std::vector<std::pair<fs::path, std::string>> m_open;  ///< files being read: canonical path, shown name
  std::vector<Placement> m_tools;  ///< tools and scope whose reach is checked when ports and instruments are known
  struct SheetEnd {
    std::string strand;
    double to;
    Location at;
  };
  std::vector<SheetEnd> m_sheet_ends;
  int m_files = 0;
  bool m_crowded = false;

  /// Too many bodies to compare all with all; told once.
  bool crowded() {
    if (!m_crowded) m_crowded = !check_counts(description, m_faults);
    return m_crowded;
  }

  std::vector<std::string> names(Reference::To to) const {
    std::vector<std::string> all;
    using To = Reference::To;
    if (to == To::tissue) add_names(description.tissues, all);
    if (to == To::solid || to == To::solid_or_strand) add_names(description.solids, all);
    if (to == To::strand || to == To::solid_or_strand) add_names(description.strands, all);
    if (to == To::port) add_names(description.ports, all);
    if (to == To::instrument) add_names(description.instruments, all);
    return all;
  }

  void check_unique(const char* what, const std::vector<std::pair<std::string, Location>>& things) {
    for (std::size_t i = 0; i < things.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (!things[i].first.empty() && things[i].first == things[j].first) {
          const Location& first = things[j].second;
          tell(m_faults,
               {things[i].second, fmt::format("expected every {} name once, got \"{}\" again (first in {}:{}:{})", what,
                                              things[i].first, first.file, first.line, first.column)});
          break;
        }
  }
  /// Two things of one name in one list are a fault at the second one.
  void check_names() {
    check_unique("tissue", description.tissues);
    check_unique("port", description.ports);
    check_unique("instrument", description.instruments);
    std::vector<std::pair<std::string, Location>> organs;
    const auto add = [&](const auto& list) {
      for (const auto& body : list) organs.emplace_back(body.name, body.at);
    };
    add(description.solids), add(description.strands), add(description.walls), add(description.sheets);
    add(description.membranes);
    check_unique("organ", organs);
  }

  template <class T>
  void check_unique(const char* what, const std::vector<T>& things) {
    std::vector<std::pair<std::string, Location>> pairs;
    for (const T& thing : things) pairs.emplace_back(thing.name, thing.at);
    check_unique(what, pairs);
  }

  void refer(Reference::To to, const JsonObject& o, const char* key) {
    if (o.has(key)) m_references.push_back({to, o.text(key), o.at(key)});
  }

  /// Reads the file at `path`, named at `from`, and calls read(object, folder).
  template <class Read>
  void include(const fs::path& path, const Location& from, const Shape& shape, Read&& read) {
    const auto refuse = [&](std::string message) { tell(m_faults, {from, std::move(message)}); };
    std::error_code error;
    const fs::path canonical = m_memory ? path : fs::weakly_canonical(path, error);
    std::string chain;
    bool cycle = false;
    for (const auto& [open, name] : m_open) {
      cycle = cycle || open == canonical;
      if (cycle) chain += name + " -> ";
    }
    if (cycle)
      return refuse(fmt::format("expected files that do not include each other in a circle, got {}{}", chain,
                                path.generic_string()));
    if (m_open.size() >= kMaxIncludeDepth)
      return refuse(fmt::format("expected at most {} files inside each other, got more", kMaxIncludeDepth));
    if (++m_files > kMaxFiles) return refuse(fmt::format("expected at most {} files, got more", kMaxFiles));
    if (!m_open.empty() && !(m_memory ? m_memory->count(path) > 0 : fs::is_regular_file(path, error)))
      return refuse(fmt::format("expected the name of a file, got \"{}\" (there is no file {})",
                                path.filename().generic_string(), path.generic_string()));
    m_open.emplace_back(canonical, path.generic_string());
    const JsonDocument document = load_json(path, m_faults, m_memory);
    read(JsonObject(document.root, shape, document.file, m_faults), path.parent_path());
    m_open.pop_back();
  }

  /// The items of an `includes` key: file names go to `file(path, place)`, objects to `inline_object`.
  template <class File, class Inline>
  void includes(const JsonObject& o, const char* key, const fs::path& folder, File&& file, Inline&& inline_object) {
    const std::vector<JsonValue>& items = o.values(key);
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (items[i].kind != JsonValue::Kind::string) continue;
      const fs::path named(items[i].text);
      if (named.empty() || named.is_absolute())
        o.fault(o.at(key, i), fmt::format("expected a file name relative to this file, got {}", shown(items[i])));
      else
        file((folder / named).lexically_normal(), o.at(key, i));
    }
    for (const JsonObject& object : o.objects(key)) inline_object(object);
  }

  void scene(const JsonObject& o, const fs::path& folder) {
    description.name = o.text("name");
    description.title = o.text("title");
    description.file = o.at().file;
    description.gravity = o.vec3("gravity_m_s2", description.gravity);
    includes(
        o, "tissues", folder,
        [this](const fs::path& path, const Location& at) {
          include(path, at, tissue_shape(), [this](const JsonObject& table, const fs::path&) {
            for (const JsonObject& row : table.objects("tissues")) tissue(row);
          });
        },
        [this](const JsonObject& row) { tissue(row); });
    organs(o, folder);
    includes(
        o, "instruments", folder,
        [this](const fs::path& path, const Location& at) {
          include(path, at, instrument_shape(), [this](const JsonObject& i, const fs::path&) { instrument(i); });
        },
        [this](const JsonObject& i) { instrument(i); });
    for (const JsonObject& p : o.objects("ports")) port(p);
    for (const JsonObject& t : o.objects("tools")) {
      refer(Reference::To::instrument, t, "instrument");
      description.placements.push_back(placement(t));
      description.placements.back().instrument = t.text("instrument");
      if (t.has("tip_mm")) m_tools.push_back(description.placements.back());
    }
    for (const JsonObject& s : o.objects("scope")) scope(s);
  }

  void tissue(const JsonObject& o) {
    Tissue t;
    t.name = o.text("name");
    t.density = o.number("density_kg_m3", t.density);
    t.young = o.number("young_Pa", 1000);
    t.p1 = o.number("p1", t.p1);
    t.p2 = o.number("p2", t.p2);
    t.strain_cap = o.number("strain_cap", t.strain_cap);
    t.failure_strain = o.number("failure_strain", t.failure_strain);
    t.damping_ms = o.number("damping_ms", t.damping_ms);
    t.source = o.text("source");
    t.at = o.at();
    // d sigma / d eps = E (1 + 2 p1 eps + 3 p2 eps^2) has no root  <=>  p1^2 < 3 p2
    if (t.p1 != 0 && !(t.p1 * t.p1 < 3 * t.p2))
      o.fault("p1",
              fmt::format("expected p1^2 < 3 p2 so that stress always rises with strain, got p1^2 = {} and 3 p2 = {}",
                          t.p1 * t.p1, 3 * t.p2));
    description.tissues.push_back(std::move(t));
  }

  void organs(const JsonObject& o, const fs::path& folder) {
    includes(
        o, "organs", folder,
        [this](const fs::path& path, const Location& at) {
          include(path, at, organ_shape(),
                  [this](const JsonObject& file, const fs::path& inner) { organ(file, inner); });
        },
        [&](const JsonObject& object) { organ(object, folder); });
  }

  void organ(const JsonObject& o, const fs::path& folder) {
    organs(o, folder);
    for (const JsonObject& s : o.objects("solids")) solid(s);
    for (const JsonObject& s : o.objects("strands")) strand(s);
    for (const JsonObject& w : o.objects("walls")) wall(w);
    for (const JsonObject& s : o.objects("sheets")) sheet(s);
    for (const JsonObject& m : o.objects("membranes")) membrane(m);
  }

  Section section(const JsonObject& o) {
    Section s;
    s.centre = from_mm(o.vec3("centre_mm"));
    s.across = from_mm(o.vec3("across_mm"));
    s.deep = from_mm(o.vec3("deep_mm"));
    s.squareness = o.number("squareness", s.squareness);
    const double a = length(s.across), b = length(s.deep);
    for (const char* key : {"across_mm", "deep_mm"})
      if (o.has(key) && !(length(from_mm(o.vec3(key))) >= 1e-5))
        o.fault(key, "expected a half axis of at least 0.01 mm, got none");
    if (a > 0 && b > 0 && !(length(cross(s.across, s.deep)) >= 0.5 * a * b))
      o.fault("deep_mm", "expected half axes at least 30 degrees apart, got nearly parallel ones");
    return s;
  }

  void solid(const JsonObject& o) {
    Solid s;
    s.name = o.text("name");
    s.tissue = o.text("tissue");
    s.look = o.text("look", s.name);
    refer(Reference::To::tissue, o, "tissue");
    for (const JsonObject& part : o.objects("sections")) {
      s.sections.push_back(section(part));
      const std::size_t n = s.sections.size();
      if (n > 1 && part.has("centre_mm") && !(length(s.sections[n - 1].centre - s.sections[n - 2].centre) >= 1e-5))
        part.fault("centre_mm", "expected a centre at least 0.01 mm from the section before, got the same place");
    }
    s.cell = from_mm(o.number("cell_mm", 5));
    s.skin_edge = o.has("skin_edge_mm") ? from_mm(o.number("skin_edge_mm")) : s.cell;
    s.fine_edge = o.has("fine_edge_mm") ? from_mm(o.number("fine_edge_mm")) : s.skin_edge / 2;
    for (const JsonObject& a : o.objects("anchors"))
      s.anchors.push_back(
          {from_mm(a.vec3("centre_mm")), from_mm(a.number("radius_mm", 1)), a.number("stiffness_N_m"), a.at()});
    s.at = o.at();
    s.cell_at = o.at("cell_mm");
    check_size(o, s);
    description.solids.push_back(std::move(s));
  }

  /// Bounds what compile would have to make of it, before it tries.
  void check_size(const JsonObject& o, const Solid& s) {
    double volume = 0, skin = 0;
    for (std::size_t i = 0; i + 1 < s.sections.size(); ++i) {
      const Section &a = s.sections[i], &b = s.sections[i + 1];
      const double height = length(b.centre - a.centre), top = area(a), bottom = area(b);
      volume += height / 3 * (top + bottom + std::sqrt(top * bottom));
      skin += height * 3 * (length(a.across) + length(a.deep) + length(b.across) + length(b.deep)) / 2;
    }
    const double nodes = 1.3 * volume / (s.cell * s.cell * s.cell);
    if (o.has("cell_mm") && nodes > kMaxSolidNodes)
      o.fault("cell_mm", fmt::format("expected a cell that fills the body with at most {} nodes, got about {:.3g}",
                                     kMaxSolidNodes, nodes));
    for (const auto& [key, edge] : {std::pair{"skin_edge_mm", s.skin_edge}, std::pair{"fine_edge_mm", s.fine_edge}})
      if (o.has(key) && 2.3 * skin / (edge * edge) > kMaxTriangles)
        o.fault(key, fmt::format("expected an edge that gives at most {} triangles, got about {:.3g}", kMaxTriangles,
                                 2.3 * skin / (edge * edge)));
  }

  StrandEnd strand_end(const JsonObject& strand, const char* key) {
    StrandEnd end;
    end.at = strand.at(key);
    for (const JsonObject& o : strand.objects(key)) {
      end.organ = o.text("solid");
      end.fixed = o.flag("fixed");
      refer(Reference::To::solid, o, "solid");
      if (end.fixed && o.has("solid")) o.fault("fixed", "expected either a solid or \"fixed\": true, got both");
    }
    return end;
  }

  void strand(const JsonObject& o) {
    Strand s;
    s.name = o.text("name");
    s.tissue = o.text("tissue");
    s.look = o.text("look", s.name);
    refer(Reference::To::tissue, o, "tissue");
    s.centreline = from_mm(o.points("centreline_mm"));
    for (std::size_t i = 1; i < s.centreline.size(); ++i)
      if (!(length(s.centreline[i] - s.centreline[i - 1]) >= 1e-5))
        o.fault(o.at("centreline_mm", i), "expected a point at least 0.01 mm from the one before, got the same place");
    s.start = strand_end(o, "start");
    s.end = strand_end(o, "end");
    s.spacing = from_mm(o.number("spacing_mm", 2.5));
    s.foundation = o.number("foundation_N_m2", s.foundation);
    s.foundation_limit = from_mm(o.number("foundation_limit_mm", 0));
    s.cuttable = o.flag("cuttable", s.cuttable);
    s.fimbriated = o.flag("fimbriated", s.fimbriated);
    s.at = o.at();
    s.spacing_at = o.at("spacing_mm");
    const double whole = curve_length(s.centreline);
    stations(o, s, whole);
    landmarks(o, s, whole);
    if (o.has("spacing_mm") && whole / s.spacing > kMaxStrandNodes)
      o.fault("spacing_mm", fmt::format("expected a spacing that gives at most {} nodes, got about {:.3g}",
                                        kMaxStrandNodes, whole / s.spacing));
    description.strands.push_back(std::move(s));
  }

  /// Is s beyond the strand's end? Smooth curves through the same points differ by a few per cent.
  static bool beyond(double s, double whole) { return whole > 0 && s > 1.05 * whole + 0.001; }
  void check_within(const JsonObject& o, const char* key, double whole) {
    if (o.has(key) && beyond(from_mm(o.number(key)), whole))
      o.fault(key, fmt::format("expected an arc length on the strand (at most {:.1f} mm), got {}", whole * 1000,
                               o.number(key)));
  }

  void stations(const JsonObject& o, Strand& s, double whole) {
    double last = -1;
    for (const JsonObject& part : o.objects("stations")) {
      const StrandStation station{from_mm(part.number("s_mm")), from_mm(part.number("radius_mm", 1)),
                                  from_mm(part.number("lumen_mm"))};
      if (part.has("s_mm") && station.s <= last)
        part.fault("s_mm", fmt::format("expected more than {} mm (stations go by rising s_mm), got {}", last * 1000,
                                       station.s * 1000));
      if (part.has("lumen_mm") && station.lumen >= station.radius)
        part.fault("lumen_mm", fmt::format("expected less than the outer radius of {} mm, got {}",
                                           station.radius * 1000, station.lumen * 1000));
      check_within(part, "s_mm", whole);
      if (part.has("s_mm")) last = station.s;
      s.stations.push_back(station);
    }
  }

  void landmarks(const JsonObject& o, Strand& s, double whole) {
    for (const JsonObject& part : o.objects("landmarks")) {
      const Landmark mark{part.text("name"), from_mm(part.number("from_mm")), from_mm(part.number("to_mm"))};
      if (part.has("from_mm") && part.has("to_mm") && !(mark.from < mark.to))
        part.fault("to_mm", fmt::format("expected more than from_mm = {}, got {}", part.number("from_mm"),
                                        part.number("to_mm")));
      check_within(part, "to_mm", whole);
      for (const Landmark& other : s.landmarks)
        if (!mark.name.empty() && other.name == mark.name)
          part.fault("name", fmt::format("expected every landmark of a strand once, got \"{}\" again", mark.name));
      s.landmarks.push_back(mark);
    }
  }

  void wall(const JsonObject& o) {
    Wall w;
    w.name = o.text("name");
    w.look = o.text("look", w.name);
    PointGrid grid = o.grid("net_mm");
    w.rows = int(grid.rows);
    w.columns = int(grid.columns);
    w.net = from_mm(std::move(grid.points));
    w.edge = from_mm(o.number("edge_mm", 4));
    w.at = o.at();
    double surface = 0;
    for (std::size_t r = 0; r + 1 < grid.rows; ++r)
      for (std::size_t c = 0; c + 1 < grid.columns; ++c) {
        const Vec3d* p = w.net.data() + r * grid.columns + c;
        surface += length(cross(p[grid.columns + 1] - p[0], p[grid.columns] - p[1])) / 2;
      }
    if (o.has("edge_mm") && 2.3 * surface / (w.edge * w.edge) > kMaxTriangles)
      o.fault("edge_mm", fmt::format("expected an edge that gives at most {} triangles, got about {:.3g}",
                                     kMaxTriangles, 2.3 * surface / (w.edge * w.edge)));
    description.walls.push_back(std::move(w));
  }

  void sheet(const JsonObject& o) {
    Sheet s;
    s.name = o.text("name");
    s.look = o.text("look", s.name);
    s.strand = o.text("strand");
    refer(Reference::To::strand, o, "strand");
    s.from = from_mm(o.number("from_mm"));
    s.to = from_mm(o.number("to_mm"));
    if (o.has("from_mm") && o.has("to_mm") && !(s.from < s.to))
      o.fault("to_mm", fmt::format("expected more than from_mm = {}, got {}", o.number("from_mm"), o.number("to_mm")));
    s.base = from_mm(o.points("base_mm"));
    s.base_organ = o.text("base_organ");
    refer(Reference::To::solid_or_strand, o, "base_organ");
    s.at = o.at();
    m_sheet_ends.push_back({s.strand, s.to, o.at("to_mm")});
    description.sheets.push_back(std::move(s));
  }

  void membrane(const JsonObject& o) {
    Membrane m;
    m.name = o.text("name");
    m.tissue = o.text("tissue");
    refer(Reference::To::tissue, o, "tissue");
    m.look = o.text("look", m.name);
    m.strand = o.text("strand");
    refer(Reference::To::strand, o, "strand");
    m.from = from_mm(o.number("from_mm"));
    m.to = from_mm(o.number("to_mm"));
    if (o.has("from_mm") && o.has("to_mm") && !(m.from < m.to))
      o.fault("to_mm", fmt::format("expected more than from_mm = {}, got {}", o.number("from_mm"), o.number("to_mm")));
    m.base = from_mm(o.points("base_mm"));
    for (std::size_t i = 1; i < m.base.size(); ++i)
      if (!(length(m.base[i] - m.base[i - 1]) >= 1e-5))
        o.fault(o.at("base_mm", i), "expected a point at least 0.01 mm from the one before, got the same place");
    m.base_on = o.texts("base_on");
    for (std::size_t i = 0; i < m.base_on.size(); ++i)
      m_references.push_back({Reference::To::solid_or_strand, m.base_on[i], o.at("base_on", i)});
    if (o.has("base_reach_mm")) m.base_reach = from_mm(o.number("base_reach_mm"));
    m.thickness = from_mm(o.number("thickness_mm", 1));
    if (o.has("spacing_mm")) m.spacing = from_mm(o.number("spacing_mm"));
    m.cuttable = o.flag("cuttable", m.cuttable);
    m.at = o.at();
    m.spacing_at = o.at("spacing_mm");
    if ((m.to - m.from) / m.spacing > kMaxStrandNodes)
      o.fault("spacing_mm", fmt::format("expected a spacing that gives at most {} columns, got about {:.3g}",
                                        kMaxStrandNodes, (m.to - m.from) / m.spacing));
    m_sheet_ends.push_back({m.strand, m.to, o.at("to_mm")});
    description.membranes.push_back(std::move(m));
  }

  void instrument(const JsonObject& o) {
    Instrument i;
    i.name = o.text("name");
    i.title = o.text("title");
    const std::string kind = o.text("kind");
    i.kind = kind == "grasper"        ? InstrumentKind::grasper
             : kind == "clip_applier" ? InstrumentKind::clip_applier
             : kind == "scissors"     ? InstrumentKind::scissors
                                      : InstrumentKind::probe;
    const auto mm = [&](const char* key, double& value) {
      if (o.has(key)) value = from_mm(o.number(key));
    };
    if (o.has("shaft_diameter_mm")) i.shaft_radius = from_mm(o.number("shaft_diameter_mm")) / 2;
    mm("shaft_length_mm", i.shaft_length);
    mm("jaw_length_mm", i.jaw_length);
    mm("jaw_width_mm", i.jaw_width);
    mm("jaw_thickness_mm", i.jaw_thickness);
    mm("parallel_gap_mm", i.parallel_gap);
    mm("clip_length_mm", i.clip_length);
    if (i.parallel_gap > 0) i.opening = 0;
    if (o.has("opening_deg")) i.opening = from_deg(o.number("opening_deg"));
    i.pinch_max = o.number("pinch_max_N", i.pinch_max);
    i.friction = o.number("friction", i.friction);
    i.clips = o.integer("clips", i.clips);
    i.at = o.at();
    if (i.parallel_gap > 0 && i.opening > 0)
      o.fault("opening_deg", "expected 0 or nothing beside parallel_gap_mm (jaws turn or stay parallel), got an angle");
    if (i.clips > 0 && o.has("kind") && i.kind != InstrumentKind::clip_applier)
      o.fault("clips", fmt::format("expected clips only in a clip_applier, got {} in a {}", i.clips, kind));
    description.instruments.push_back(std::move(i));
  }

  void port(const JsonObject& o) {
    Port p;
    p.name = o.text("name");
    p.position = from_mm(o.vec3("position_mm"));
    if (o.has("diameter_mm")) p.diameter = from_mm(o.number("diameter_mm"));
    p.at = o.at();
    description.ports.push_back(std::move(p));
  }

  Placement placement(const JsonObject& o) {
    refer(Reference::To::port, o, "port");
    Placement p;
    p.port = o.text("port");
    p.tip = from_mm(o.vec3("tip_mm"));
    p.roll = from_deg(o.number("roll_deg"));
    p.at = o.at("tip_mm");
    return p;
  }

  void scope(const JsonObject& o) {
    Scope s;
    if (o.has("angle_deg")) s.angle = from_deg(o.number("angle_deg"));
    s.field_of_view = from_deg(o.number("field_of_view_deg", 70));
    if (o.has("shaft_diameter_mm")) s.shaft_radius = from_mm(o.number("shaft_diameter_mm")) / 2;
    if (o.has("shaft_length_mm")) s.shaft_length = from_mm(o.number("shaft_length_mm"));
    description.scope = s;
    description.scope_placement = placement(o);
    if (o.has("tip_mm")) m_tools.push_back(description.scope_placement);
  }

  /// Does the shaft fit through its port and reach from there to its tip?
  void check_tool(const Placement& tool) {
    const auto named = [](const auto& list, const std::string& name) {
      return std::find_if(list.begin(), list.end(), [&](const auto& thing) { return thing.name == name; });
    };
    const auto port = named(description.ports, tool.port);
    const auto instrument = named(description.instruments, tool.instrument);
    const bool is_scope = tool.instrument.empty();
    if (port == description.ports.end() || (!is_scope && instrument == description.instruments.end())) return;
    const double radius = is_scope ? description.scope.shaft_radius : instrument->shaft_radius;
    const double reach = is_scope ? description.scope.shaft_length : instrument->shaft_length + instrument->jaw_length;
    const double depth = length(tool.tip - port->position);
    if (!(depth >= 0.005 && depth <= reach))
      tell(m_faults, {tool.at, fmt::format("expected a tip 5 to {:.0f} mm from the port \"{}\", got {:.1f} mm",
                                           reach * 1000, tool.port, depth * 1000)});
    if (2 * radius > port->diameter * 1.000001)
      tell(m_faults, {tool.at, fmt::format("expected a port of at least {} mm for this shaft, got \"{}\" of {} mm",
                                           2000 * radius, tool.port, port->diameter * 1000)});
  }

  void check_sheet(const SheetEnd& sheet) {
    for (const Strand& strand : description.strands) {
      const double whole = curve_length(strand.centreline);
      if (strand.name == sheet.strand && beyond(sheet.to, whole))
        tell(m_faults, {sheet.at, fmt::format("expected an arc length on \"{}\" (at most {:.1f} mm), got {}",
                                              strand.name, whole * 1000, sheet.to * 1000)});
    }
  }
};

/// Faults in the order in which a person meets them: file by file as read, then by place.
void sort_faults(std::vector<core::Fault>& faults) {
  std::vector<std::string> files;
  const auto rank = [&](const core::Fault& f) {
    return std::find(files.begin(), files.end(), f.at.file) - files.begin();
  };
  for (const core::Fault& f : faults)
    if (rank(f) == std::ptrdiff_t(files.size())) files.push_back(f.at.file);
  std::stable_sort(faults.begin(), faults.end(), [&](const core::Fault& a, const core::Fault& b) {
    const auto ra = rank(a), rb = rank(b);
    if (ra != rb) return ra < rb;
    return a.at.line != b.at.line ? a.at.line < b.at.line : a.at.column < b.at.column;
  });
}

std::vector<fs::path> sorted_entries(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace

Description read_scene(const fs::path& path, const MemoryFiles* memory) {
  std::vector<core::Fault> faults;
  Reading reading(faults, memory);
  reading.scene_file(path);
  reading.resolve();
  reading.check_together();
  sort_faults(faults);
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  return std::move(reading.description);
}

FileKind kind_of_file(const fs::path& path, const MemoryFiles* memory) {
  std::vector<core::Fault> ignored;
  const JsonDocument document = load_json(path, ignored, memory);
  const auto has = [&](const char* key) { return document.root.find(key) != nullptr; };
  if (has("scene")) return FileKind::exercise;
  if (has("scope") || has("ports") || has("tools")) return FileKind::scene;
  if (has("kind")) return FileKind::instrument;
  if (has("solids") || has("strands") || has("walls") || has("sheets") || has("membranes") || has("organs"))
    return FileKind::organ;
  return has("tissues") ? FileKind::tissue : FileKind::scene;
}

std::vector<core::Fault> check_file(const fs::path& path, const MemoryFiles* memory) {
  std::vector<core::Fault> faults;
  Reading reading(faults, memory);
  switch (kind_of_file(path, memory)) {
    case FileKind::scene:
      reading.scene_file(path);
      reading.resolve();
      break;
    case FileKind::organ:
      reading.organ_file(path);
      break;
    case FileKind::instrument:
      reading.instrument_file(path);
      break;
    case FileKind::tissue:
      reading.tissue_file(path);
      break;
    case FileKind::exercise:
      load_json(path, faults, memory);
      break;
  }
  reading.check_together();
  sort_faults(faults);
  return faults;
}

std::vector<SceneEntry> list_scenes(const fs::path& folder) {
  std::vector<SceneEntry> entries;
  for (const fs::path& path : sorted_entries(folder)) {
    const fs::path file = path / "scene.json";
    std::error_code error;
    if (!fs::is_regular_file(file, error)) continue;
    std::vector<core::Fault> ignored;
    const JsonDocument document = load_json(file, ignored);
    const JsonMember* title = document.root.find("title");
    entries.push_back({path.filename().generic_string(), title ? title->value.text : "", file});
  }
  return entries;
}

std::vector<InstrumentEntry> list_instruments(const fs::path& folder) {
  std::vector<InstrumentEntry> entries;
  for (const fs::path& path : sorted_entries(folder)) {
    std::vector<core::Fault> faults;
    if (path.extension() != ".json") continue;
    const JsonDocument document = load_json(path, faults);
    const JsonObject o(document.root, instrument_shape(), document.file, faults);
    if (faults.empty()) entries.push_back({o.text("name"), o.text("kind"), o.text("title"), path});
  }
  return entries;
}

}  // namespace trocar::scene

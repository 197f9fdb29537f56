// Faults that can be found only when all files are read: names that nobody has or that two have, reaches across things.
#include <algorithm>
#include <map>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/scene/description/capacity.hpp>
#include <trocar/scene/files/look_file.hpp>
#include <trocar/scene/files/reader_parts.hpp>

namespace trocar::scene {
namespace {

using NamedPlace = std::pair<std::string, core::Location>;

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
    case Reference::To::carrier:
      return "solid, strand, membrane or pouch";
    case Reference::To::tied:
      return "solid, strand, membrane, pouch or fat";
    case Reference::To::vessel:
      return "vessel";
    case Reference::To::port:
      return "port";
    case Reference::To::instrument:
      return "instrument";
    case Reference::To::look:
      return "look";
    case Reference::To::drawn:
      return "body, wall, instrument, port, cavity, endoscope, arteries or veins";
    case Reference::To::marked:
      return "solid, wall, strand or pouch";
    case Reference::To::pouch:
      return "pouch";
  }
  return "";
}

template <class T>
void add_names(const std::vector<T>& things, std::vector<std::string>& names) {
  for (const T& thing : things)
    if (!thing.name.empty()) names.push_back(thing.name);
}

template <class T>
std::vector<NamedPlace> places_of(const std::vector<T>& things) {
  std::vector<NamedPlace> places;
  for (const T& thing : things) places.emplace_back(thing.name, thing.at);
  return places;
}

/// Two things of one name in one list are a fault at the second one.
void check_unique(const char* what, const std::vector<NamedPlace>& things, std::vector<core::Fault>& faults) {
  for (std::size_t i = 0; i < things.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!things[i].first.empty() && things[i].first == things[j].first) {
        const core::Location& first = things[j].second;
        tell(faults, {things[i].second, tr("expected every {} name once, got \"{}\" again (first in {}:{}:{})", what,
                                           things[i].first, first.file, first.line, first.column)});
        break;
      }
}

}  // namespace

void Reading::looks(const std::filesystem::path& first) {
  const std::vector<std::filesystem::path> beside{first.parent_path() / "looks"};
  const MaterialFolders materials(m_library ? m_library->folders("looks") : beside, m_faults, m_memory);
  description.looks = materials.library();
  if (!MemoryFiles::disk_too(m_memory) && materials.empty()) return;  // a scene that is nothing but a text
  const std::vector<std::string> known = materials.names();
  for (const Reference& reference : m_references)
    if (reference.to == Reference::To::look && std::find(known.begin(), known.end(), reference.name) == known.end())
      tell(m_faults, {reference.at, unknown_name("look", reference.name, known)});
}

void Reading::resolve() {
  if (!crowded()) resolve(m_references);
}

void Reading::resolve(const std::vector<Reference>& references) {
  for (const Reference& reference : references) {
    if (reference.to == Reference::To::look) continue;
    const std::vector<std::string> known = names(reference.to);
    if (std::find(known.begin(), known.end(), reference.name) == known.end())
      tell(m_faults, {reference.at, unknown_name(noun(reference.to), reference.name, known)});
  }
}

void Reading::check_together() {
  if (crowded()) return;
  if (m_faults.empty()) check_capacity(description, m_faults);
  check_names();
  for (const Placement& tool : m_tools) check_tool(tool);
  for (const SheetEnd& sheet : m_sheet_ends) check_sheet(sheet);
  for (const WaveSetting& wave : description.peristalsis) check_wave(wave);
  for (const MarkSetting& mark : description.marks) check_mark(mark);
  if (description.variation && description.variation->bleeder && !description.bleeder)
    tell(m_faults, {description.variation->at, "expected a bleeder with a variable hole, got none in this scene"});
  if (description.variation)
    for (const VariationSetting::Finding& finding : description.variation->findings) check_finding(finding);
  if (description.variation && m_faults.empty()) check_variants();
}

void Reading::check_variants() {
  const Description common = description;
  const std::vector<VariationSetting::Variant>& variants = common.variation->variants;
  if (!common.variant.empty() && !find_variant(*common.variation, common.variant))
    tell(m_faults,
         {common.variation->at, tr("expected the variant \"{}\" of the scene, got none of this name", common.variant)});
  for (std::size_t i = 0; i < variants.size() && m_faults.empty(); ++i) {
    put_in(description, variants[i]);
    if (i < m_of_variants.size()) resolve(m_of_variants[i]);
    if (check_counts(description, m_faults)) check_capacity(description, m_faults);
    check_names();
    for (const MarkSetting& mark : description.marks) check_mark(mark);
    description = common;
  }
}

void Reading::check_finding(const VariationSetting::Finding& finding) {
  std::vector<std::string> marks = finding.with;
  marks.insert(marks.begin(), finding.mark);
  for (const std::string& name : marks) {
    const auto is_it = [&](const MarkSetting& mark) { return mark.name == name; };
    if (std::none_of(description.marks.begin(), description.marks.end(), is_it))
      tell(m_faults, {finding.at, tr("expected a finding's mark to be one of the scene's, got \"{}\"", name)});
  }
}

bool Reading::crowded() {
  if (!m_crowded) m_crowded = !check_counts(description, m_faults);
  return m_crowded;
}

std::vector<std::string> Reading::names(Reference::To to) const {
  std::vector<std::string> all;
  using To = Reference::To;
  if (to == To::tied) add_names(settings_of(FatScene{}, description.objects), all);
  if (to == To::carrier || to == To::tied) {
    add_names(description.solids, all), add_names(description.strands, all);
    add_names(description.membranes, all), add_names(description.pouches, all);
  }
  if (to == To::tissue) add_names(description.tissues, all);
  if (to == To::solid || to == To::solid_or_strand) add_names(description.solids, all);
  if (to == To::strand || to == To::solid_or_strand) add_names(description.strands, all);
  if (to == To::marked) {
    add_names(description.solids, all), add_names(description.walls, all), add_names(description.strands, all);
    add_names(description.pouches, all);
  }
  if (to == To::pouch) add_names(description.pouches, all);
  if (to == To::vessel)
    for (const VesselTree& tree : description.vessels) add_names(tree.vessels, all);
  if (to == To::drawn) {
    add_names(description.solids, all), add_names(description.strands, all), add_names(description.walls, all);
    add_names(description.sheets, all), add_names(description.membranes, all), add_names(description.pouches, all);
    add_names(description.instruments, all), add_names(description.ports, all);
    ObjectScenes::for_each([&](auto kind) { add_names(settings_of(kind, description.objects), all); });
    all.insert(all.end(), kDrawnNames.begin(), kDrawnNames.end());
  }
  if (to == To::port) add_names(description.ports, all);
  if (to == To::instrument) add_names(description.instruments, all);
  return all;
}

void Reading::check_names() {
  check_unique("tissue", places_of(description.tissues), m_faults);
  check_unique("port", places_of(description.ports), m_faults);
  check_unique("instrument", places_of(description.instruments), m_faults);
  check_vessel_names();
  std::vector<NamedPlace> organs;
  const auto add = [&](const auto& list) {
    for (const auto& body : list) organs.emplace_back(body.name, body.at);
  };
  add(description.solids), add(description.strands), add(description.walls), add(description.sheets);
  add(description.membranes), add(description.pouches), add(description.marks);
  ObjectScenes::for_each([&](auto kind) { add(settings_of(kind, description.objects)); });
  check_unique("organ", organs, m_faults);
}

/// Those of one file are compared there; there may be thousands.
void Reading::check_vessel_names() {
  if (description.vessels.size() < 2) return;
  std::map<std::string, core::Location> seen;
  for (const VesselTree& tree : description.vessels)
    for (const Vessel& v : tree.vessels) {
      const auto [first, fresh] = seen.try_emplace(v.name, v.at);
      if (!fresh && first->second.file != v.at.file)
        tell(m_faults, {v.at, tr("expected every vessel name once, got \"{}\" again (first in {}:{}:{})", v.name,
                                 first->second.file, first->second.line, first->second.column)});
    }
}

/// Does the shaft fit through its port and reach from there to its tip?
void Reading::check_tool(const Placement& tool) {
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
    tell(m_faults, {tool.at, tr("expected a tip 5 to {:.0f} mm from the port \"{}\", got {:.1f} mm", reach * 1000,
                                tool.port, depth * 1000)});
  if (2 * radius > port->diameter * 1.000001)
    tell(m_faults, {tool.at, tr("expected a port of at least {} mm for this shaft, got \"{}\" of {} mm", 2000 * radius,
                                tool.port, port->diameter * 1000)});
}

void Reading::check_sheet(const SheetEnd& sheet) {
  for (const Strand& strand : description.strands) {
    const double whole = curve_length(strand.centreline);
    if (strand.name == sheet.strand && beyond(sheet.to, whole))
      tell(m_faults, {sheet.at, tr("expected an arc length on \"{}\" (at most {:.1f} mm), got {}", strand.name,
                                   whole * 1000, sheet.to * 1000)});
  }
}

/// Stripes go around strands, discs do not lie on them.
void Reading::check_mark(const MarkSetting& mark) {
  const auto named = [&](const auto& thing) { return thing.name == mark.on; };
  const auto strand = std::find_if(description.strands.begin(), description.strands.end(), named);
  const bool around = strand != description.strands.end();
  if (mark.stripe && !around)
    tell(m_faults, {mark.at, tr("expected a strand that the stripe goes around, got \"{}\"", mark.on)});
  if (!mark.stripe && around)
    tell(m_faults, {mark.at, tr("expected at_mm of a stripe on the strand \"{}\", got a disc", mark.on)});
  if (!mark.stripe || !around) return;
  const double whole = curve_length(strand->centreline);
  if (beyond(mark.s, whole))
    tell(m_faults, {mark.at, tr("expected an arc length on \"{}\" (at most {:.1f} mm), got {}", mark.on, whole * 1000,
                                mark.s * 1000)});
}

/// Do its organ and its stations fit it?
void Reading::check_wave(const WaveSetting& wave) {
  for (const Solid& solid : description.solids) {
    if (solid.name != wave.solid || wave.solid.empty()) continue;
    if (solid.cuttable)
      tell(m_faults, {wave.solid_at, tr("expected a solid that is not cuttable, got \"{}\"", solid.name)});
    std::vector<Vec3d> line = wave.centreline;
    if (line.empty())
      for (const Section& s : solid.sections) line.push_back(s.centre);
    if (line.empty() && solid.shape.tube) line = solid.shape.tube->line;
    if (line.size() < 2) {
      tell(m_faults,
           {wave.at,
            tr("expected \"centreline_mm\" for \"{}\", which has no sections and is no tube, got none", solid.name)});
      continue;
    }
    const double whole = curve_length(line);
    for (const WaveSetting::Station& s : wave.stations)
      if (beyond(s.s, whole))
        tell(m_faults, {s.at, tr("expected an arc length on the centre line (at most {:.1f} mm), got {}", whole * 1000,
                                 s.s * 1000)});
  }
}

}  // namespace trocar::scene

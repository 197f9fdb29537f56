#include <array>
#include <cctype>
#include <filesystem>

#include <trocar/core/letters.hpp>
#include <trocar/core/text.hpp>
#include <trocar/modeller/document/plain_words.hpp>

namespace trocar::modeller {
namespace {

struct Words {
  std::string_view key;
  const char* words;
};

constexpr Words kKeyWords[] = {{"name", "Name"},
                               {"title", "Title"},
                               {"tissue", "Tissue"},
                               {"look", "Material"},
                               {"of", "Of"},
                               {"on", "On"},
                               {"file", "File"},
                               {"part", "Part of the file"},
                               {"cell_mm", "Cell size (mm)"},
                               {"refill_mm", "Cell size (mm)"},
                               {"skin_edge_mm", "Contact mesh size (mm)"},
                               {"fine_edge_mm", "Drawn mesh size (mm)"},
                               {"spacing_mm", "Mesh size (mm)"},
                               {"unit_mm", "Unit of the file (mm)"},
                               {"place_mm", "Place (mm)"},
                               {"centre_mm", "Centre (mm)"},
                               {"half_mm", "Half axes (mm)"},
                               {"radius_mm", "Radius (mm)"},
                               {"radii_mm", "Radii (mm)"},
                               {"lumen_mm", "Radius of the lumen (mm)"},
                               {"thickness_mm", "Wall thickness (mm)"},
                               {"line_mm", "Points of the line (mm)"},
                               {"path_mm", "Points of the vessel (mm)"},
                               {"centreline_mm", "Centre line (mm)"},
                               {"from_mm", "From (mm)"},
                               {"to_mm", "To (mm)"},
                               {"across_mm", "Half width (mm)"},
                               {"deep_mm", "Half depth (mm)"},
                               {"within_mm", "Largest deviation (mm)"},
                               {"position_mm", "Position (mm)"},
                               {"tip_mm", "Tip (mm)"},
                               {"diameter_mm", "Diameter (mm)"},
                               {"size_mm", "Size (mm)"},
                               {"sections", "Cross-sections"},
                               {"anchors", "Attachments"},
                               {"held", "Attachments"},
                               {"held_on", "Attached to"},
                               {"regions", "Stiffness by region"},
                               {"surface", "Imported surface"},
                               {"mesh", "Imported tetrahedra"},
                               {"mend", "Close holes"},
                               {"cuttable", "Can be cut"},
                               {"pouch", "Hollow (pouch)"},
                               {"stiffness_N_m", "Stiffness (N/m)"},
                               {"stiffness", "Stiffness (times)"},
                               {"toughness_J_m2", "Toughness (J/m²)"},
                               {"flow_mL_min", "Flow (mL/min)"},
                               {"fibre", "Fibre direction"},
                               {"fibre_ratio", "Stiffness along the fibres (times)"},
                               {"ratio", "Stiffness along the fibres (times)"},
                               {"start_on", "Start attached to"},
                               {"end_on", "End attached to"},
                               {"start", "Start"},
                               {"end", "End"},
                               {"stations", "Width along the line"},
                               {"strand", "Tube or cord"},
                               {"onto", "Organ"},
                               {"points", "Points"},
                               {"head_down_deg", "Head down (°)"},
                               {"left_down_deg", "Left side down (°)"},
                               {"young_Pa", "Young's modulus (Pa)"},
                               {"density_kg_m3", "Density (kg/m³)"},
                               {"solver", "Solver"},
                               {"elasticity", "Elastic law"},
                               {"masses", "Masses"},
                               {"contents", "Contents"},
                               {"bonds", "Bonds"},
                               {"as", "Keep as"}};

constexpr Words kUnits[] = {{"_mm", "mm"},     {"_deg", "°"},       {"_Pa", "Pa"},
                            {"_kPa", "kPa"},   {"_N", "N"},         {"_N_m", "N/m"},
                            {"_N_mm", "N/mm"}, {"_mL", "mL"},       {"_mL_min", "mL/min"},
                            {"_ms", "ms"},     {"_s", "s"},         {"_mmHg", "mmHg"},
                            {"_J_m2", "J/m²"}, {"_kg_m3", "kg/m³"}, {"_m_s2", "m/s²"},
                            {"_Hz", "Hz"},     {"_mm_s", "mm/s"},   {"_mmHg_s_mL", "mmHg s/mL"}};

struct KindWords {
  std::string_view kind;
  const char *one, *many;
};
constexpr KindWords kKindWords[] = {{"solid", "Organ", "Organs"},
                                    {"strand", "Tube or cord", "Tubes and cords"},
                                    {"wall", "Environment surface", "Environment surfaces"},
                                    {"sheet", "Drawn fold", "Drawn folds"},
                                    {"membrane", "Membrane", "Membranes"},
                                    {"pouch", "Hollow organ", "Hollow organs"},
                                    {"vessel", "Vessel", "Vessels"},
                                    {"port", "Port", "Ports"},
                                    {"mark", "Mark", "Marks"},
                                    {"rigid", "Rigid object", "Rigid objects"},
                                    {"fat", "Fat", "Fat"},
                                    {"bag", "Retrieval bag", "Retrieval bags"},
                                    {"instrument", "Instrument", "Instruments"},
                                    {"tissue", "Tissue", "Tissues"}};

bool ends_with(std::string_view text, std::string_view ending) {
  return text.size() > ending.size() && text.substr(text.size() - ending.size()) == ending;
}

}  // namespace

std::string label_of_key(std::string_view key) {
  for (const Words& w : kKeyWords)
    if (w.key == key) return tr(w.words);
  const Words* unit = nullptr;  // the longest that fits
  for (const Words& u : kUnits)
    if (ends_with(key, u.key) && (!unit || u.key.size() > unit->key.size())) unit = &u;
  std::string out(unit ? key.substr(0, key.size() - unit->key.size()) : key);
  for (char& c : out)
    if (c == '_') c = ' ';
  out = core::with_capital(std::move(out));
  return unit ? out + " (" + unit->words + ")" : out;
}

std::string label_of_kind(std::string_view kind, bool many) {
  for (const KindWords& w : kKindWords)
    if (w.kind == kind) return tr(many ? w.many : w.one);
  return std::string(kind);
}

const char* stiffness_in_words(double young) {
  constexpr double kVerySoft = 3e3, kSoft = 12e3, kMedium = 4e4, kFirm = 2e5;
  if (young < kVerySoft) return tr("very soft");
  if (young < kSoft) return tr("soft");
  if (young < kMedium) return tr("medium");
  return young < kFirm ? tr("firm") : tr("very firm");
}

std::string fault_in_words(const core::Fault& fault) {
  const std::string file = std::filesystem::path(fault.at.file).filename().string();
  return tr("{}, line {}: {}", file, fault.at.line, fault.message);
}

}  // namespace trocar::modeller

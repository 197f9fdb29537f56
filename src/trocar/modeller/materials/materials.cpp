#include <algorithm>
#include <cctype>
#include <utility>

#include <trocar/core/letters.hpp>
#include <trocar/modeller/document/outline.hpp>
#include <trocar/modeller/materials/materials.hpp>
#include <trocar/scene/files/library.hpp>
#include <trocar/scene/files/look_file.hpp>

namespace trocar::modeller {
namespace {

/// Letters only, in lower case: "VH_F_Uterus-2" is "vhfuterus".
std::string letters_of(const std::string& name) {
  std::string out;
  for (const char c : name)
    if (const char small = core::small_letter(c); small >= 'a' && small <= 'z') out += small;
  return out;
}

/// Words in names of organs, and the tissue and material that fit; the first that fits counts. Our estimate.
struct Hint {
  const char *word, *tissue, *material;
};
constexpr Hint kHints[] = {{"gallbladder", "gallbladder_wall", "gallbladder"},
                           {"cysticduct", "bile_duct", "cystic_duct"},
                           {"bileduct", "bile_duct", "common_duct"},
                           {"artery", "artery_wall", "artery"},
                           {"arteries", "artery_wall", "artery"},
                           {"vein", "artery_wall", "vein"},
                           {"aorta", "artery_wall", "artery"},
                           {"vessel", "artery_wall", "artery"},
                           {"ligament", "ligament", "round_ligament"},
                           {"uterus", "uterus", "uterus"},
                           {"ovary", "ovary", "ovary"},
                           {"ovaries", "ovary", "ovary"},
                           {"fallopian", "tube", "tube"},
                           {"tube", "tube", "tube"},
                           {"liver", "liver", "liver_lifted"},
                           {"hepar", "liver", "liver_lifted"},
                           {"bladder", "bladder", "bladder"},
                           {"stomach", "stomach_wall", "stomach"},
                           {"appendix", "large_bowel_wall", "appendix"},
                           {"colon", "large_bowel_wall", "colon"},
                           {"largeintestine", "large_bowel_wall", "colon"},
                           {"rectum", "large_bowel_wall", "bowel"},
                           {"jejunum", "small_bowel_wall", "jejunum"},
                           {"smallintestine", "small_bowel_wall", "small_bowel"},
                           {"bowel", "bowel", "bowel"},
                           {"intestine", "bowel", "bowel"},
                           {"mesentery", "mesentery", "mesentery"},
                           {"omentum", "fat", "omentum"},
                           {"fat", "fat", "fat"},
                           {"spleen", "liver", "liver_lifted"},
                           {"kidney", "liver", "liver_lifted"}};

const Hint* hint_for(const std::string& name) {
  const std::string letters = letters_of(name);
  for (const Hint& hint : kHints)
    if (letters.find(hint.word) != std::string::npos) return &hint;
  return nullptr;
}

bool is_material(const std::string& name) {
  const std::vector<MaterialChoice>& all = material_choices();
  return std::any_of(all.begin(), all.end(), [&](const MaterialChoice& m) { return m.name == name; });
}

}  // namespace

std::vector<TissueChoice> tissue_choices(const Document& document) {
  std::vector<TissueChoice> out;
  for (const Thing& thing : outline(document))
    if (thing.kind == "tissue") {
      const scene::JsonValue value = value_of(document, thing);
      const scene::JsonMember* young = value.find("young_Pa");
      out.push_back({thing.name, young ? young->value.number : 0.0});
    }
  if (out.empty()) {  // an organ alone: what the place to model in has
    std::error_code error;
    const std::optional<fs::path> scenes = scene::found_scenes_folder();
    if (scenes && fs::is_regular_file(*scenes / "tissues.json", error) &&
        whole_path(*scenes / "tissues.json") != document.root())
      return tissue_choices(Document::open(*scenes / "tissues.json"));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const TissueChoice& a, const TissueChoice& b) { return a.young < b.young; });
  return out;
}

const std::vector<MaterialChoice>& material_choices() {
  static const std::vector<MaterialChoice> all = [] {
    std::vector<MaterialChoice> out;
    const std::optional<fs::path> scenes = scene::found_scenes_folder();
    if (!scenes) return out;
    std::vector<core::Fault> faults;
    const scene::MaterialFolders materials({*scenes / "looks"}, faults);
    for (const sim::Look& look : materials.library()->looks)
      if (look.surface == sim::Look::Surface::tissue && !look.moulded && look.name != "neutral")
        out.push_back({look.name, look.colour, look.patches, look.flecks, look.vessel_colour.value_or(look.tint)});
    std::sort(out.begin(), out.end(), [](const MaterialChoice& a, const MaterialChoice& b) { return a.name < b.name; });
    return out;
  }();
  return all;
}

std::string material_of_tissue(std::string tissue) {
  if (const std::size_t wall = tissue.rfind("_wall"); wall != tissue.npos) tissue.resize(wall);
  if (tissue == "liver") return "liver_lifted";  // as a body of its own: the material "liver" draws the dome above it
  const std::optional<fs::path> scenes = scene::found_scenes_folder();
  std::error_code error;
  return scenes && fs::is_regular_file(*scenes / "looks" / (tissue + ".json"), error) ? tissue : std::string();
}

std::string tissue_for_name(const std::string& name, const std::vector<TissueChoice>& tissues) {
  const auto known = [&](const std::string& tissue) {
    return std::any_of(tissues.begin(), tissues.end(), [&](const TissueChoice& t) { return t.name == tissue; });
  };
  if (known(name)) return name;
  const Hint* hint = hint_for(name);
  return hint && known(hint->tissue) ? hint->tissue : std::string();
}

std::string material_for(const std::string& name, const std::string& tissue) {
  if (const Hint* hint = hint_for(name); hint && is_material(hint->material)) return hint->material;
  return is_material(name) ? name : material_of_tissue(tissue);
}

}  // namespace trocar::modeller

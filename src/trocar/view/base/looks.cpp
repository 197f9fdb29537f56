#include <algorithm>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include <trocar/core/log.hpp>
#include <trocar/view/base/looks.hpp>

namespace trocar::view {
namespace {

Vec3f colour_of(Vec3d srgb) { return render::srgb(float(srgb.x), float(srgb.y), float(srgb.z)); }

render::Material material_of(const sim::Look& l) {
  render::Material m;
  m.shading = l.surface == sim::Look::Surface::metal ? render::Shading::metal : render::Shading::tissue;
  m.colour = colour_of(l.colour);
  m.colour_b = colour_of(l.patches);
  m.colour_c = colour_of(l.flecks);
  m.tint = colour_of(l.tint);
  m.mottle_size = float(l.mottle_size);
  m.mottle = float(l.mottle);
  m.lobule_size = float(l.lobule_size);
  m.lobule_depth = float(l.lobule_depth);
  m.lobule_contrast = float(l.lobule_contrast);
  m.fibre_stretch = float(l.fibre_stretch);
  m.bump = float(l.bump);
  if (l.vessel_colour) m.vessel_colour = colour_of(*l.vessel_colour);
  m.vessels = float(l.vessels);
  m.vessel_tile = float(l.vessel_tile);
  m.arcade = l.arcade;
  m.lining = l.lining;
  m.roughness = float(l.roughness);
  m.wetness = float(l.wetness);
  m.film_roughness = float(l.film_roughness);
  m.film_size = float(l.film_size);
  m.film_bump = float(l.film_bump);
  m.fresnel = float(l.fresnel);
  m.wrap = vec_cast<float>(l.wrap);
  m.glow = vec_cast<float>(l.glow);
  m.glow_amount = float(l.glow_amount);
  m.alpha = float(l.alpha);
  m.rim_alpha = float(l.rim_alpha);
  m.two_sided = l.two_sided;
  m.scatter = float(l.scatter);
  m.soil = float(l.soil);
  return m;
}

Relief relief_of(const sim::Look::Relief& r) {
  return {.broad = r.broad,
          .broad_size = r.broad_size,
          .fine = r.fine,
          .fine_size = r.fine_size,
          .follicles = r.follicles,
          .follicle_radius = r.follicle_radius,
          .scars = r.scars,
          .ripe = r.ripe,
          .lopsided = r.lopsided,
          .haustra = r.haustra,
          .haustra_size = r.haustra_size,
          .spiral = r.spiral,
          .spiral_size = r.spiral_size};
}

Look drawn(const sim::Look& l) {
  return {l.name, material_of(l), l.translucent, l.moulded, relief_of(l.relief), l.surroundings};
}

/// A library with what was made of it; both live as long as some Model keeps the library.
struct DrawnLibrary {
  std::weak_ptr<const sim::MaterialLibrary> of;
  std::unique_ptr<const std::vector<Look>> looks;
};

std::unique_ptr<const std::vector<Look>> drawn(const sim::MaterialLibrary& library) {
  auto looks = std::make_unique<std::vector<Look>>();
  for (const sim::Look& l : library.looks) looks->push_back(drawn(l));
  return looks;
}

const std::vector<Look>& neutral() {
  static const std::vector<Look> one = [] {
    sim::Look l;
    l.name = "neutral";
    return std::vector<Look>{drawn(l)};
  }();
  return one;
}

}  // namespace

int Look::count(Generator generator) const {
  for (const sim::Surrounding& s : surroundings)
    if (s.generator == generator) return s.count;
  return 0;
}

const Look& wall_look(const sim::Model& model) {
  return look(model, model.walls.empty() ? "peritoneum" : model.walls.front().look);
}

bool is_alive(const Look& look) {
  return look.material.shading == render::Shading::tissue && look.material.glow_amount > 0;
}

const std::vector<Look>& all_looks(const sim::Model& model) {
  if (!model.looks) return neutral();
  static std::mutex mutex;
  static std::map<const sim::MaterialLibrary*, DrawnLibrary> libraries;
  const std::lock_guard lock(mutex);
  for (auto b = libraries.begin(); b != libraries.end();)
    b = b->second.of.expired() ? libraries.erase(b) : std::next(b);
  DrawnLibrary& library = libraries[model.looks.get()];
  if (!library.looks) library = {model.looks, drawn(*model.looks)};
  return *library.looks;
}

const Look& look(const sim::Model& model, const std::string& name) {
  for (const Look& l : all_looks(model))
    if (l.name == name) return l;
  static std::mutex mutex;
  static std::set<std::string> reported;
  const std::lock_guard lock(mutex);
  if (reported.insert(name).second) core::log::warn("look \"{}\" is not known: a neutral tissue is drawn", name);
  return neutral().front();
}

}  // namespace trocar::view

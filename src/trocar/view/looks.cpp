#include <mutex>
#include <set>

#include <trocar/core/log.hpp>
#include <trocar/view/looks.hpp>

namespace trocar::view {
namespace {

using render::Material;
using render::Shading;
using render::srgb;

/// Main colour, broad patches, fine flecks.
Material tissue(Vec3f main, Vec3f broad, Vec3f fine) {
  Material m;
  m.colour = main;
  m.colour_b = broad;
  m.colour_c = fine;
  m.tint = broad;
  return m;
}

Material with_vessels(Material m, float amount, float tile) {
  m.vessels = amount;
  m.vessel_tile = tile;
  return m;
}

Material uterus() {
  Material m = with_vessels(tissue(srgb(200, 148, 150), srgb(208, 164, 164), srgb(188, 124, 128)), 0.5f, 0.046f);
  m.mottle_size = 0.013f;
  m.mottle = 0.4f;
  m.bump = 0.1f;
  m.film_bump = 0.28f;
  m.film_roughness = 0.13f;
  m.film_size = 0.0028f;
  return m;
}

Material tube() {
  Material m = with_vessels(tissue(srgb(204, 138, 136), srgb(212, 156, 150), srgb(188, 112, 114)), 0.7f, 0.024f);
  m.mottle_size = 0.007f;
  m.glow_amount = 0.16f;
  m.tint = srgb(190, 88, 94);  // fimbriae
  m.film_size = 0.0018f;
  return m;
}

Material ovary() {
  Material m = with_vessels(tissue(srgb(230, 208, 194), srgb(234, 216, 204), srgb(216, 182, 168)), 0.22f, 0.03f);
  m.mottle_size = 0.006f;
  m.mottle = 0.45f;
  m.lobule_size = 0.0062f;
  m.lobule_depth = 0.13f;
  m.lobule_contrast = 0.1f;
  m.bump = 0.1f;
  m.film_roughness = 0.1f;
  m.tint = srgb(206, 176, 170);  // a follicle
  return m;
}

Material ligament(Vec3f main, Vec3f broad, Vec3f fine) {
  Material m = with_vessels(tissue(main, broad, fine), 0.6f, 0.026f);
  m.mottle_size = 0.006f;
  m.bump = 0.14f;
  m.tint = srgb(206, 128, 122);
  return m;
}

Material bladder() {
  Material m = with_vessels(tissue(srgb(206, 148, 138), srgb(214, 166, 152), srgb(190, 120, 116)), 0.9f, 0.05f);
  m.mottle_size = 0.016f;
  m.mottle = 0.45f;
  return m;
}

Material bowel() {
  Material m = with_vessels(tissue(srgb(202, 122, 120), srgb(208, 146, 140), srgb(186, 102, 104)), 0.8f, 0.036f);
  m.mottle_size = 0.012f;
  m.glow_amount = 0.1f;
  return m;
}

Material peritoneum() {
  Material m = with_vessels(tissue(srgb(182, 116, 110), srgb(190, 136, 124), srgb(166, 94, 92)), 0.95f, 0.06f);
  m.mottle_size = 0.022f;
  m.mottle = 0.6f;
  m.two_sided = true;
  return m;
}

Material fold(float alpha) {
  Material m = with_vessels(tissue(srgb(206, 148, 142), srgb(214, 168, 158), srgb(192, 122, 118)), 0.95f, 0.03f);
  m.mottle_size = 0.011f;
  m.alpha = alpha;
  m.rim_alpha = 0.92f;
  m.two_sided = true;
  m.glow_amount = 0.12f;
  return m;
}

Material fat() {
  Material m = with_vessels(tissue(srgb(216, 150, 112), srgb(222, 168, 126), srgb(204, 128, 98)), 0.6f, 0.03f);
  m.lobule_size = 0.006f;
  m.lobule_depth = 0.4f;
  m.lobule_contrast = 0.5f;
  m.glow_amount = 0.12f;
  return m;
}

Material metal(Vec3f bright, Vec3f dull, float roughness) {
  Material m;
  m.shading = Shading::metal;
  m.colour = bright;
  m.colour_b = dull;
  m.colour_c = dull;
  m.tint = srgb(24, 24, 26);
  m.roughness = roughness;
  m.mottle_size = 0.0025f;
  m.fibre_stretch = 14;
  m.bump = 0.05f;
  return m;
}

Material insulation() {
  Material m = metal(srgb(92, 92, 97), srgb(84, 84, 90), 0.5f);
  m.bump = 0.03f;
  return m;
}

std::vector<Look> make_looks() {
  const Material cord = ligament(srgb(210, 158, 152), srgb(216, 174, 164), srgb(196, 132, 130));
  const Material pale_cord = ligament(srgb(214, 168, 158), srgb(220, 182, 170), srgb(202, 144, 138));
  const Material pedicle = ligament(srgb(200, 138, 132), srgb(208, 156, 146), srgb(182, 112, 112));
  Material neutral = tissue(srgb(196, 134, 130), srgb(204, 150, 142), srgb(182, 112, 112));
  return {
      {"neutral", neutral},
      {"uterus", uterus()},
      {"tube", tube()},
      {"fimbria", tube()},
      {"ovary", ovary()},
      {"round_ligament", cord},
      {"ovarian_ligament", pale_cord},
      {"infundibulopelvic_ligament", pedicle},
      {"infundibulopelvic", pedicle},
      {"bladder", bladder()},
      {"bowel", bowel()},
      {"fat", fat()},
      {"peritoneum", peritoneum()},
      {"mesosalpinx", fold(0.5f), true},
      {"broad_ligament", fold(0.62f), true},
      {"steel", metal(srgb(172, 172, 176), srgb(152, 152, 158), 0.36f)},
      {"insulated", insulation()},
      {"titanium", metal(srgb(182, 184, 190), srgb(164, 166, 172), 0.3f)},
  };
}

}  // namespace

const std::vector<Look>& all_looks() {
  static const std::vector<Look> looks = make_looks();
  return looks;
}

const Look& look(const std::string& name) {
  for (const Look& l : all_looks())
    if (l.name == name) return l;
  static std::mutex mutex;
  static std::set<std::string> reported;
  const std::lock_guard lock(mutex);
  if (reported.insert(name).second) core::log::warn("look \"{}\" is not known: a neutral tissue is drawn", name);
  return all_looks().front();
}

}  // namespace trocar::view

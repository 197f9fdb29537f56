#include <mutex>
#include <set>

#include <trocar/core/log.hpp>
#include <trocar/view/base/fold_pattern.hpp>
#include <trocar/view/base/looks.hpp>

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
  Material m = with_vessels(tissue(srgb(201, 148, 152), srgb(212, 172, 168), srgb(184, 114, 124)), 0.8f, 0.038f);
  m.mottle_size = 0.014f;
  m.mottle = 0.5f;
  m.bump = 0.12f;
  m.film_bump = 0.27f;
  m.film_roughness = 0.075f;
  m.film_size = 0.0015f;
  m.wetness = 0.62f;  // one broad sheen, few flecks
  return m;
}

Material tube() {
  Material m = with_vessels(tissue(srgb(194, 124, 125), srgb(206, 150, 138), srgb(184, 108, 112)), 0.75f, 0.024f);
  m.mottle_size = 0.011f;
  m.mottle = 0.6f;
  m.bump = 0.1f;
  m.glow_amount = 0.38f;         // through the thin rims of the fimbriae
  m.tint = srgb(188, 114, 121);  // fimbriae: lining, as soft as velvet
  m.film_size = 0.0013f;         // much finer than the tube is thick: flecks in clumps, no row of beads
  m.film_bump = 0.24f;
  m.film_roughness = 0.06f;
  m.wetness = 0.54f;
  return m;
}

Material ovary() {
  Material m = with_vessels(tissue(srgb(218, 192, 180), srgb(226, 206, 186), srgb(196, 156, 156)), 0.5f, 0.026f);
  m.mottle_size = 0.008f;
  m.mottle = 0.35f;
  m.bump = 0.14f;
  m.film_roughness = 0.1f;
  m.film_bump = 0.24f;
  m.film_size = 0.0015f;
  m.wetness = 0.5f;  // pearly
  m.glow_amount = 0.1f;
  m.tint = srgb(196, 166, 172);  // a follicle
  return m;
}

Material ligament(Vec3f main, Vec3f broad, Vec3f fine) {
  Material m = with_vessels(tissue(main, broad, fine), 0.6f, 0.026f);
  m.mottle_size = 0.009f;
  m.mottle = 0.6f;
  m.bump = 0.12f;
  m.film_bump = 0.26f;
  m.film_size = 0.0015f;  // finer than the cord is thick: no row of beads
  m.wetness = 0.6f;
  m.film_roughness = 0.08f;
  m.tint = srgb(202, 142, 144);  // the uterus
  return m;
}

/// Seen through the peritoneum: paler than blood, and lit as that is, not as a cord on it.
Material vessel(Vec3f main, Vec3f broad, Vec3f fine) {
  Material m = tissue(main, broad, fine);
  m.mottle_size = 0.006f;
  m.mottle = 0.4f;
  m.film_size = 0.0018f;
  m.film_bump = 0.12f;
  m.wetness = 0.05f;  // under a film: no glints of its own
  m.fresnel = 0.006f;
  m.wrap = {0.8f, 0.75f, 0.75f};
  return m;
}

/// Within a fold: both its walls are seen through each other, softest at its sides, and what is in it has no glint.
Material veiled(Vec3f main, Vec3f broad, Vec3f fine) {
  Material m = vessel(main, broad, fine);
  m.alpha = 0.42f;
  m.rim_alpha = 0;
  m.wrap = {1, 1, 1};
  m.wetness = 0;
  m.fresnel = 0.004f;
  m.glow_amount = 0;
  return m;
}

Material peritoneum() {
  Material m = with_vessels(tissue(srgb(180, 118, 120), srgb(191, 133, 117), srgb(168, 102, 112)), 0.8f, 0.13f);
  m.lining = true;
  m.mottle_size = 0.024f;
  m.mottle = 0.3f;
  m.bump = 0.08f;
  m.wetness = 0.52f;
  m.tint = srgb(199, 142, 109);  // fat below it
  m.film_size = 0.0021f;         // of muscle fibres that shimmer through: its film is as smooth as it is wide
  m.film_bump = 0.07f;
  m.film_roughness = 0.14f;
  m.two_sided = true;
  return m;
}

Material bladder() {
  Material m = peritoneum();  // it lies below the peritoneum
  m.lining = false;
  m.two_sided = false;
  m.colour = srgb(198, 122, 124);
  m.colour_b = srgb(212, 150, 126);
  m.colour_c = srgb(184, 106, 109);
  m.tint = srgb(208, 152, 119);
  m.mottle_size = 0.013f;
  m.mottle = 0.3f;
  m.vessels = 1.2f;
  m.vessel_tile = 0.05f;
  m.wetness = 0.6f;
  m.film_size = 0.002f;
  m.film_bump = 0.4f;
  m.film_roughness = 0.075f;
  return m;
}

Material bowel() {
  Material m = with_vessels(tissue(srgb(198, 121, 121), srgb(205, 137, 132), srgb(189, 108, 111)), 0.9f, 0.036f);
  m.mottle_size = 0.012f;
  m.mottle = 0.45f;
  m.glow_amount = 0.1f;
  m.bump = 0.05f;
  m.film_bump = 0.18f;
  m.film_size = 0.0024f;
  m.film_roughness = 0.06f;
  m.wetness = 0.95f;
  m.tint = srgb(215, 174, 167);  // its bands
  return m;
}

/// Its diaphragm is muscle: darker, redder.
Material upper_abdomen() {
  Material m = peritoneum();
  m.colour = srgb(146, 84, 89);
  m.colour_b = srgb(155, 94, 94);
  m.colour_c = srgb(137, 75, 81);
  m.tint = srgb(172, 116, 86);
  return m;
}

/// Thin walls, moist; no bands.
Material small_bowel() {
  Material m = with_vessels(tissue(srgb(209, 138, 139), srgb(216, 154, 149), srgb(198, 121, 125)), 0.85f, 0.03f);
  m.mottle_size = 0.014f;
  m.mottle = 0.5f;
  m.glow_amount = 0.1f;
  m.bump = 0.05f;
  m.film_bump = 0.32f;
  m.film_size = 0.0024f;
  m.film_roughness = 0.06f;
  m.wetness = 0.95f;
  return m;
}

Material stomach() {
  Material m = with_vessels(tissue(srgb(200, 124, 116), srgb(208, 140, 126), srgb(184, 106, 102)), 1.0f, 0.046f);
  m.mottle_size = 0.022f;
  m.mottle = 0.5f;
  m.bump = 0.05f;
  m.film_bump = 0.32f;
  m.film_size = 0.002f;
  m.film_roughness = 0.05f;
  m.wetness = 0.9f;
  return m;
}

Material liver() {
  Material m = with_vessels(tissue(srgb(74, 42, 46), srgb(89, 50, 53), srgb(70, 39, 43)), 0.15f, 0.026f);
  m.vessel_colour = srgb(150, 106, 110);  // a pale net below its capsule
  m.mottle_size = 0.008f;
  m.mottle = 0.65f;       // one colour over a hand's breadth
  m.glow_amount = 0.02f;  // no bright line along its edge
  m.bump = 0.016f;
  m.roughness = 0.72f;
  m.wetness = 0.76f;  // unbroken: a dry place would be a dark blotch where the dome turns away
  m.film_roughness = 0.03f;
  m.film_bump = 0.22f;  // so smooth that it sparkles only where it faces the lamp, in flecks with hard edges
  m.film_size = 0.0013f;
  m.fresnel = 0.012f;            // the capsule is matte but for the film's flecks, and so is what a cut lays bare
  m.tint = srgb(166, 104, 100);  // a thin edge
  return m;
}

/// Cream where it is lit, grey-violet in shade: never green from outside; with fat where it lies on the liver.
Material gallbladder() {
  Material m = with_vessels(tissue(srgb(188, 152, 146), srgb(204, 174, 152), srgb(166, 124, 130)), 1.0f, 0.034f);
  m.mottle_size = 0.013f;
  m.mottle = 0.55f;
  m.two_sided = true;
  m.wetness = 0.85f;
  m.film_roughness = 0.1f;
  m.film_bump = 0.2f;
  m.film_size = 0.0034f;
  m.glow = {0.8f, 0.45f, 0.25f};
  m.glow_amount = 0.08f;
  m.wrap = {0.34f, 0.3f, 0.2f};
  m.tint = srgb(222, 180, 118);  // fat
  return m;
}

Material fold(float alpha) {
  Material m = with_vessels(tissue(srgb(214, 160, 154), srgb(228, 186, 158), srgb(200, 136, 132)), 1.0f, 0.03f);
  m.mottle_size = 0.016f;
  m.mottle = 0.45f;
  m.alpha = alpha;
  m.rim_alpha = 0.85f;
  m.two_sided = true;
  m.glow_amount = 0.12f;
  m.wetness = 0.55f;
  m.film_bump = 0.16f;
  m.film_size = 0.0026f;
  m.tint = srgb(222, 164, 122);  // fat along its borders
  return m;
}

/// Where it runs out on a wall it takes on that one's colour (tint).
Material broad_ligament() {
  Material m = fold(0.78f);
  m.wetness = 0.12f;
  m.film_size = 0.0021f;
  m.film_bump = 0.09f;
  m.film_roughness = 0.15f;
  m.tint = peritoneum().colour;
  return m;
}

/// Sheer and milky: what lies behind it is seen as through ground glass, with hardly a glint.
Material mesosalpinx() {
  Material m = fold(0.46f);
  m.colour = srgb(206, 158, 152);
  m.colour_b = srgb(222, 184, 154);
  m.colour_c = srgb(196, 140, 138);
  m.mottle_size = 0.009f;
  m.mottle = 0.6f;
  m.roughness = 0.6f;
  m.wetness = 0.12f;
  m.film_bump = 0.1f;
  m.film_roughness = 0.16f;
  m.film_size = 0.0022f;
  m.tint = srgb(226, 178, 146);  // fat along its borders
  m.vessel_colour = srgb(148, 26, 40);
  m.vessel_tile = float(kFoldTile);
  m.arcade = true;
  return m;
}

/// Whitish, thin.
Material adhesion() {
  Material m = fold(0.72f);
  m.colour = srgb(218, 184, 176);
  m.colour_b = srgb(224, 194, 180);
  m.colour_c = srgb(206, 164, 156);
  m.tint = srgb(234, 214, 204);  // strands in it
  m.vessels = 0.55f;             // fine ones, here and there
  m.vessel_tile = 0.02f;
  m.wetness = 0.22f;
  m.film_bump = 0.1f;
  m.rim_alpha = 0.3f;
  return m;
}

/// A thin sheet with fat in its free border.
Material falciform() {
  Material m = fold(0.24f);
  m.colour = srgb(172, 112, 106);
  m.colour_b = srgb(180, 126, 112);
  m.colour_c = srgb(158, 92, 94);
  m.vessel_tile = 0.06f;
  m.rim_alpha = 0.7f;
  m.tint = srgb(182, 128, 108);
  return m;
}

Material fat() {
  Material m = with_vessels(tissue(srgb(216, 142, 102), srgb(222, 160, 114), srgb(206, 122, 98)), 0.9f, 0.016f);
  m.mottle_size = 0.006f;
  m.lobule_size = 0.0034f;
  m.lobule_depth = 0.1f;
  m.lobule_contrast = 0.05f;
  m.glow_amount = 0.12f;
  m.film_bump = 0.25f;
  m.tint = srgb(206, 126, 118);  // where it grows out of the bowel
  return m;
}

/// Lobules on lobules (omentum.cpp): these are the smallest. Towards its border and in grooves it is salmon (tint).
Material omentum() {
  Material m = fat();
  m.colour = srgb(228, 154, 137);
  m.colour_b = srgb(238, 176, 128);
  m.colour_c = srgb(216, 128, 120);
  m.mottle_size = 0.014f;
  m.mottle = 0.65f;
  m.bump = 0.03f;
  m.lobule_size = 0.0044f;
  m.lobule_depth = 0.2f;
  m.lobule_contrast = 0.09f;
  m.vessels = 0.7f;
  m.vessel_tile = 0.07f;
  m.vessel_colour = srgb(166, 56, 48);
  m.wetness = 0.56f;
  m.film_roughness = 0.05f;
  m.film_bump = 0.16f;
  m.film_size = 0.0024f;
  m.tint = srgb(206, 130, 124);
  m.two_sided = true;
  return m;
}

/// Tags on the large bowel: what the omentum is made of, below a thin wet serosa, with finer capillaries.
Material epiploic() {
  Material m = omentum();
  m.colour = srgb(224, 152, 118);
  m.colour_b = srgb(234, 168, 122);
  m.colour_c = srgb(212, 130, 110);
  m.lobule_size = 0.0026f;
  m.lobule_depth = 0.32f;
  m.lobule_contrast = 0.2f;
  m.vessels = 1;
  m.vessel_tile = 0.02f;
  m.wetness = 1;  // sparkles everywhere
  m.film_bump = 0.34f;
  m.film_size = 0.0014f;
  m.glow_amount = 0.22f;  // through the thin borders of its tongues
  m.two_sided = false;
  m.tint = bowel().colour;  // where it grows out of that
  return m;
}

/// Its lower border in the pelvis: near the lens, thin, wet, with smaller lobules.
Material omentum_border() {
  Material m = omentum();
  m.colour = srgb(230, 163, 134);
  m.colour_b = srgb(240, 182, 132);
  m.colour_c = srgb(221, 142, 126);
  m.mottle_size = 0.011f;
  m.lobule_size = 0.0034f;
  m.lobule_depth = 0.3f;
  m.lobule_contrast = 0.11f;
  m.vessels = 0.85f;
  m.vessel_tile = 0.05f;
  m.wetness = 0.9f;
  m.film_bump = 0.26f;
  m.film_size = 0.0018f;
  return m;
}

/// Bare metal, dull from use: a little of the light is scattered; a hand's instrument says how soiled it is.
Material metal(Vec3f bright, Vec3f dull, float roughness) {
  Material m;
  m.shading = Shading::metal;
  m.colour = bright;
  m.colour_b = dull;
  m.colour_c = dull;
  m.tint = srgb(24, 24, 26);
  m.roughness = roughness;
  m.scatter = 0.14f;
  m.mottle_size = 0.0016f;
  m.fibre_stretch = 9;
  m.bump = 0.03f;
  m.soil = 0;
  return m;
}

/// Blades and clips: hardly any grinding marks.
Material polished(Vec3f bright, Vec3f dull, float roughness, float scatter) {
  Material m = metal(bright, dull, roughness);
  m.scatter = scatter;
  m.mottle = 0.2f;
  m.fibre_stretch = 2.5f;
  m.bump = 0.02f;
  return m;
}

/// Titanium: paler than steel and less of a mirror, drawn as a wire: it glints where it is bent and along its edges.
Material satin(Vec3f bright, Vec3f dull) {
  Material m = metal(bright, dull, 0.33f);
  m.scatter = 0.82f;
  m.mottle = 0.7f;
  m.fibre_stretch = 1;
  m.bump = 0.035f;
  return m;
}

/// The plastic tube around a shaft.
Material insulation() {
  Material m = metal(srgb(66, 65, 69), srgb(57, 57, 61), 0.34f);
  m.bump = 0.03f;
  m.fibre_stretch = 10;
  m.scatter = 0.75f;
  return m;
}

/// Ceramic and PTFE: white, used.
Material ceramic() {
  Material m = metal(srgb(208, 203, 192), srgb(188, 181, 168), 0.36f);
  m.fibre_stretch = 1;
  m.mottle_size = 0.004f;
  m.bump = 0.01f;
  m.scatter = 1;
  return m;
}

std::vector<Look> make_looks() {
  const Material cord = ligament(srgb(212, 160, 148), srgb(224, 184, 164), srgb(192, 124, 122));
  const Material pale_cord = ligament(srgb(216, 168, 156), srgb(228, 192, 172), srgb(200, 138, 134));
  Material sacral = ligament(srgb(188, 130, 127), srgb(200, 148, 132), srgb(174, 110, 114));  // below the peritoneum
  sacral.wetness = 0.4f;
  Material pedicle = ligament(srgb(200, 130, 124), srgb(214, 160, 138), srgb(174, 96, 102));
  pedicle.tint = srgb(214, 184, 172);  // the ovary
  const Material artery = vessel(srgb(134, 50, 52), srgb(148, 64, 60), srgb(112, 38, 44));
  const Material vein = vessel(srgb(104, 60, 70), srgb(118, 74, 78), srgb(88, 46, 60));
  const Material neutral = tissue(srgb(196, 134, 130), srgb(204, 150, 142), srgb(182, 112, 112));
  return {
      {"neutral", neutral, false, {}},
      {"uterus",
       uterus(),
       false,
       {.broad = 0.0011, .broad_size = 0.027, .fine = 0.00012, .fine_size = 0.006, .lopsided = 0.0019}},
      {"tube", tube(), false, {}},
      {"fimbria", tube(), false, {}},
      {"ovary",
       ovary(),
       false,
       {.broad = 0.0009,
        .broad_size = 0.017,
        .fine = 0.0002,
        .fine_size = 0.0045,
        .follicles = 11,
        .follicle_radius = 0.0034,
        .scars = 9,
        .ripe = 0.0056,
        .lopsided = 0.0012},
       0,
       3},
      {"round_ligament", cord, false, {}},
      {"ovarian_ligament", pale_cord, false, {}},
      {"uterosacral_ligament", sacral, false, {}},
      {"infundibulopelvic_ligament", pedicle, false, {}},
      {"bladder",
       bladder(),
       false,
       {.broad = 0.0014, .broad_size = 0.03, .fine = 0.0002, .fine_size = 0.008},
       0,
       0,
       true},
      {"bowel",
       bowel(),
       false,
       {.broad = 0.0005,
        .broad_size = 0.02,
        .fine = 0.00015,
        .fine_size = 0.006,
        .haustra = 0.0024,
        .haustra_size = 0.023},
       18,
       9},
      {"small_bowel",
       small_bowel(),
       false,
       {.broad = 0.0003, .broad_size = 0.014, .fine = 0.00012, .fine_size = 0.005},
       0,
       2},
      {"stomach", stomach(), false, {.broad = 0.0008, .broad_size = 0.026, .fine = 0.00015, .fine_size = 0.008}},
      {"liver", liver(), false, {.broad = 0.0013, .broad_size = 0.022}, 0, 0, false, false, true},
      {"gallbladder",
       gallbladder(),
       false,
       {.broad = 0.0005, .broad_size = 0.017, .fine = 0.00012, .fine_size = 0.005}},
      {"fat", epiploic(), false, {.broad = 0.001, .broad_size = 0.012, .fine = 0.0006, .fine_size = 0.005}},
      {"artery", artery, false, {}},
      {"vein", vein, false, {}},
      {"artery_in_fold", veiled(srgb(124, 32, 44), srgb(136, 46, 54), srgb(106, 26, 38)), true, {}},
      {"vein_in_fold", veiled(srgb(112, 62, 80), srgb(122, 76, 88), srgb(96, 48, 66)), true, {}},
      {"peritoneum", peritoneum(), false, {}},
      {"upper_abdomen", upper_abdomen(), false, {}, 0, 0, false, true},
      {"omentum", omentum(), false, {}},
      {"omentum_border", omentum_border(), false, {}},
      {"mesosalpinx", mesosalpinx(), true, {}},
      {"broad_ligament", broad_ligament(), true, {}},
      {"adhesion", adhesion(), true, {}},
      {"falciform", falciform(), true, {}},
      {"steel", metal(srgb(146, 148, 151), srgb(118, 120, 124), 0.3f), false, {}},
      {"polished_steel", polished(srgb(140, 142, 146), srgb(118, 120, 125), 0.2f, 0.2f), false, {}},
      {"matte_steel", metal(srgb(128, 129, 133), srgb(114, 115, 120), 0.46f), false, {}},
      {"insulated", insulation(), false, {}},
      {"ceramic", ceramic(), false, {}},
      {"sleeve", metal(srgb(130, 131, 137), srgb(116, 118, 124), 0.38f), false, {}},
      {"titanium", satin(srgb(244, 240, 239), srgb(220, 217, 219)), false, {}},
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

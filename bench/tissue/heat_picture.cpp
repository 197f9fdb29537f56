// A picture of what current leaves: tissue from above and, below the line, cut through the middle. From the left: 40 W
// for 1 s, 40 W for 3 s, 60 W for 8 s in one place; right: a hook in pure cut, 40 W, drawn 10 mm in 2 s.
//
//   ninja -C build/release heat_picture && build/release/bench/tissue/heat_picture OUT.png
#include <cstdio>

#include <trocar/render/frame/image.hpp>
#include <trocar/tissue/heat/electrosurgery.hpp>
#include <trocar/tissue/heat/heat_look.hpp>

namespace {

using namespace trocar;
using namespace trocar::tissue;

void fill_below(const void*, BodyId, Vec3d corner, double cell, std::span<std::uint8_t> tissue) noexcept {
  for (int c = 0; c < kBrickCells; ++c) tissue[c] = corner.z + (c / (kBrickSide * kBrickSide) + 0.5) * cell < 0;
}

struct Tissue {
  HeatModel m = build(HeatDescription{});
  HeatState s = cold(m);
  HeatWork w = make_work(m);
  ElectrodeDescription e;
  ElectrodeState es;
  GeneratorPanel panel;

  void press(double seconds, FootSwitch pedals, Vec3d from, Vec3d to) {
    const int ticks = int(seconds * 1000);
    const TissueShape shape{nullptr, fill_below};
    for (int t = 0; t < ticks; ++t) {
      const Vec3d at = from + (double(t) / ticks) * (to - from);
      const Discharge d = energise(e, panel, pedals, {.body = BodyId::strand(0), .a = at, .b = at}, m, shape, s, w, es);
      advance(m, d.span(), shape, s, w);
    }
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "heat_picture OUT.png\n");
    return 2;
  }
  Tissue tissue;
  const FootSwitch blue{.yellow = false, .blue = true}, yellow{.yellow = true, .blue = false};
  const auto stay = [&](double seconds, double x) { tissue.press(seconds, blue, {x, 0, -1e-4}, {x, 0, -1e-4}); };
  stay(1, -12e-3);
  stay(3, -4e-3);
  tissue.panel.blue_watts = 60;
  stay(8, 5e-3);
  tissue.press(2, yellow, {12e-3, -5e-3, -1e-4}, {12e-3, 5e-3, -1e-4});

  constexpr int kWidth = 900, kHeight = 560, kCut = 400;
  constexpr double kPixel = 36e-3 / kWidth;
  render::Image picture;
  picture.width = kWidth;
  picture.height = kHeight;
  for (int j = 0; j < kHeight; ++j)
    for (int i = 0; i < kWidth; ++i) {
      const double x = (i - kWidth / 2) * kPixel;
      const Vec3d at = j < kCut ? Vec3d{x, (kCut / 2 - j) * kPixel, -1e-4} : Vec3d{x, 0, -(j - kCut) * kPixel};
      const Vec3f c =
          j == kCut ? Vec3f{} : colour(look(reading(tissue.m, tissue.s, BodyId::strand(0), at)), {0.62f, 0.28f, 0.25f});
      for (const float v : {c.x, c.y, c.z}) picture.rgb.push_back(std::uint8_t(v * 255 + 0.5f));
    }
  render::write_png(argv[1], picture);
  return 0;
}

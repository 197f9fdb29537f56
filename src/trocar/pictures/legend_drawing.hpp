// What a picture's colours mean, drawn into its lower left corner: in pictures and films as pixels, in windows over the
// picture. Both are laid out alike.
#pragma once

#include <memory>
#include <vector>

#include <imgui.h>

#include <trocar/render/frame/image.hpp>
#include <trocar/view/analysis/analysis.hpp>

namespace trocar::pictures {

struct LegendBox {
  float x = 0, y = 0, width = 0, height = 0;  ///< [px, from the top left]
  view::Colour colour;
  float alpha = 1;
};
struct LegendText {
  float x = 0, y = 0;  ///< upper left [px]
  std::string text;
};
struct LegendLayout {
  float width = 0, height = 0;
  std::vector<LegendBox> boxes;
  std::vector<LegendText> texts;
};
/// @param font  at `size` [px]
LegendLayout lay_out_legend(const view::Legend& legend, const ImFont& font, float size);

/// Over the part of the window whose lower left corner is (x, y), no wider than `width` [px].
void draw_legend(const view::Legend& legend, ImDrawList& over, float x, float y, float width);

/// Into pictures. Needs no window.
class LegendPainter {
 public:
  LegendPainter();
  ~LegendPainter();
  /// Nothing where it does not fit.
  void paint(const view::Legend& legend, render::Image& image);
  /// A picture of nothing but the legend, in texts of that size [px]; empty where there is none.
  render::Image alone(const view::Legend& legend, int size);

 private:
  void write(const LegendLayout& layout, int left, int top, render::Image& image);
  void load(int size);

  struct Font;
  std::unique_ptr<Font> m_font;  ///< for pictures as high as the last one
};

}  // namespace trocar::pictures

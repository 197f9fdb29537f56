#include <algorithm>
#include <cmath>
#include <filesystem>

#include <trocar/core/font_file.hpp>
#include <trocar/pictures/legend_drawing.hpp>
#include <trocar/pictures/picture_size.hpp>

namespace trocar::pictures {
namespace {

constexpr float kMargin = 0.6f;                   // of the text's height, around everything
constexpr float kBarWidth = 15, kBarHigh = 0.9f;  // of a colour bar, in text heights
constexpr view::Colour kPaper{0.05f, 0.055f, 0.065f};
constexpr float kPaperAlpha = 0.78f;
const ImVec4 kInk{0.95f, 0.95f, 0.95f, 1};

float width_of(const ImFont& font, float size, const std::string& text) {
  return font.CalcTextSizeA(size, 1e6f, 0, text.c_str()).x;
}

}  // namespace

LegendLayout lay_out_legend(const view::Legend& legend, const ImFont& font, float size) {
  LegendLayout l;
  const float margin = kMargin * size, bar = kBarWidth * size, line = 1.25f * size;
  l.boxes.push_back({});  // the paper
  float y = margin, widest = 0;
  const auto say = [&](float x, const std::string& text) {
    l.texts.push_back({x, y, text});
    widest = std::max(widest, x + width_of(font, size, text));
  };
  for (const view::Legend::Bar& b : legend.bars) {
    say(margin, b.title);
    y += line;
    const float step = bar / float(b.colours.size());
    const float inset = 0.5f * width_of(font, size, b.ticks.front()) + margin;  // the first tick stands below its end
    for (std::size_t i = 0; i < b.colours.size(); ++i)
      l.boxes.push_back({inset + step * float(i), y, step, kBarHigh * size, b.colours[i]});
    y += kBarHigh * size + 0.15f * size;
    for (std::size_t t = 0; t < b.ticks.size(); ++t) {
      const float at = inset + bar * float(t) / float(b.ticks.size() - 1);
      say(at - 0.5f * width_of(font, size, b.ticks[t]), b.ticks[t]);
    }
    y += line + 0.3f * size;
  }
  for (const view::Legend::Key& k : legend.keys) {
    l.boxes.push_back({margin, y + 0.4f * size, 1.6f * size, 0.28f * size, k.colour});
    say(margin + 2.1f * size, k.text);
    y += line;
  }
  l.width = widest + margin;
  l.height = y + 0.2f * size;
  l.boxes.front() = {0, 0, l.width, l.height, kPaper, kPaperAlpha};
  return l;
}

void draw_legend(const view::Legend& legend, ImDrawList& over, float x, float y, float width) {
  const ImFont& font = *ImGui::GetFont();
  float size = ImGui::GetFontSize();
  LegendLayout l = lay_out_legend(legend, font, size);
  if (l.width > width) l = lay_out_legend(legend, font, size *= width / l.width);
  const float top = y - l.height;
  for (const LegendBox& b : l.boxes)
    over.AddRectFilled({x + b.x, top + b.y}, {x + b.x + b.width, top + b.y + b.height},
                       ImGui::GetColorU32(ImVec4{b.colour.r, b.colour.g, b.colour.b, b.alpha}));
  for (const LegendText& t : l.texts)
    over.AddText(&font, size, {x + t.x, top + t.y}, ImGui::GetColorU32(kInk), t.text.c_str());
}

/// ImGui's glyphs as a picture of how opaque they are; no window is needed for that.
struct LegendPainter::Font {
  ImFontAtlas atlas;
  ImFont* font = nullptr;
  unsigned char* alpha = nullptr;
  int width = 0, height = 0, size = 0;

  explicit Font(int pixels) : size(pixels) {
    const std::string file = core::font_file("DejaVuSans.ttf");
    ImFontConfig config;
    config.OversampleH = config.OversampleV = 1;  // a pixel of the atlas is one of the picture
    config.PixelSnapH = true;
    config.SizePixels = float(pixels);
    if (!file.empty()) font = atlas.AddFontFromFileTTF(file.c_str(), float(pixels), &config);
    if (!font) font = atlas.AddFontDefault(&config);
    atlas.GetTexDataAsAlpha8(&alpha, &width, &height);
  }
};

namespace {

void blend(render::Image& image, int x, int y, view::Colour c, float alpha) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  std::uint8_t* p = image.rgb.data() + 3 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x));
  const float ink[3] = {c.r, c.g, c.b};
  for (int k = 0; k < 3; ++k) p[k] = std::uint8_t(float(p[k]) * (1 - alpha) + 255 * ink[k] * alpha + 0.5f);
}

void fill(render::Image& image, const LegendBox& b, int left, int top) {
  const int x0 = left + int(std::lround(b.x)), x1 = left + int(std::lround(b.x + b.width));
  const int y0 = top + int(std::lround(b.y)), y1 = top + int(std::lround(b.y + b.height));
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) blend(image, x, y, b.colour, b.alpha);
}

/// @param atlas  how opaque its pixels are, of that size
void put_glyph(render::Image& image, const ImFontGlyph& g, const unsigned char* atlas, PictureSize size, float x,
               float y) {
  if (!g.Visible) return;
  const int from_x = int(std::lround(g.U0 * float(size.width))), from_y = int(std::lround(g.V0 * float(size.height)));
  const int wide = int(std::lround(g.X1 - g.X0)), high = int(std::lround(g.Y1 - g.Y0));
  const int left = int(std::lround(x + g.X0)), top = int(std::lround(y + g.Y0));
  for (int row = 0; row < high; ++row)
    for (int column = 0; column < wide; ++column) {
      const std::size_t at = std::size_t(from_y + row) * std::size_t(size.width) + std::size_t(from_x + column);
      blend(image, left + column, top + row, {kInk.x, kInk.y, kInk.z}, float(atlas[at]) / 255);
    }
}

}  // namespace

LegendPainter::LegendPainter() = default;
LegendPainter::~LegendPainter() = default;

void LegendPainter::load(int size) {
  if (!m_font || m_font->size != size) m_font = std::make_unique<Font>(size);
}

void LegendPainter::paint(const view::Legend& legend, render::Image& image) {
  if (legend.bars.empty() && legend.keys.empty()) return;
  const int size = std::clamp(image.height / 42, 11, 40);
  load(size);
  const LegendLayout l = lay_out_legend(legend, *m_font->font, float(size));
  if (l.width > float(image.width) || l.height > float(image.height)) return;
  write(l, std::min(size, image.width - int(l.width)), std::max(0, image.height - size - int(l.height)), image);
}

render::Image LegendPainter::alone(const view::Legend& legend, int size) {
  if (legend.bars.empty() && legend.keys.empty()) return {};
  load(size);
  const LegendLayout l = lay_out_legend(legend, *m_font->font, float(size));
  render::Image image{int(std::ceil(l.width)), int(std::ceil(l.height)), {}};
  image.rgb.resize(3 * std::size_t(image.width) * std::size_t(image.height));
  write(l, 0, 0, image);
  return image;
}

void LegendPainter::write(const LegendLayout& l, int left, int top, render::Image& image) {
  for (const LegendBox& b : l.boxes) fill(image, b, left, top);
  for (const LegendText& t : l.texts) {
    float pen = float(left) + t.x;
    for (const char c : t.text) {
      const ImFontGlyph* g = m_font->font->FindGlyph(ImWchar(static_cast<unsigned char>(c)));
      put_glyph(image, *g, m_font->alpha, {m_font->width, m_font->height}, pen, float(top) + t.y);
      pen += g->AdvanceX;
    }
  }
}

}  // namespace trocar::pictures

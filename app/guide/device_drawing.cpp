#include "guide/device_drawing.hpp"

#include <string_view>

#include <trocar/core/text.hpp>

#include "shell/ui.hpp"

namespace trocar::app {
namespace {

const ImVec4 kBody{0.20f, 0.23f, 0.27f, 1}, kPart{0.30f, 0.34f, 0.40f, 1}, kUsed{0.10f, 0.42f, 0.66f, 1};

ImU32 paint(const ImVec4& colour) { return ImGui::GetColorU32(colour); }

/// Shapes in units of a drawing that is `width` wide.
class Sketch {
 public:
  Sketch(ImVec2 at, float unit) : m_draw(*ImGui::GetWindowDrawList()), m_at(at), m_unit(unit) {}
  ImVec2 at(float x, float y) const { return {m_at.x + x * m_unit, m_at.y + y * m_unit}; }
  float length(float l) const { return l * m_unit; }
  void box(float x, float y, float w, float h, const ImVec4& colour, float round = 0.1f) const {
    m_draw.AddRectFilled(at(x, y), at(x + w, y + h), paint(colour), length(round));
  }
  void disc(float x, float y, float r, const ImVec4& colour) const {
    m_draw.AddCircleFilled(at(x, y), length(r), paint(colour), 32);
  }
  void line(ImVec2 from, ImVec2 to) const {
    m_draw.AddLine(at(from.x, from.y), at(to.x, to.y), paint(ui::kOrange), 1.5f * ui::scale());
  }
  /// In the middle of (x, y).
  void name(float x, float y, const std::string& text, const ImVec4& colour = ui::kWhite) const {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str()), middle = at(x, y);
    m_draw.AddText({middle.x - 0.5f * size.x, middle.y - 0.5f * size.y}, paint(colour), text.c_str());
  }
  /// A line from a part to its name; `right`: the name begins there, else it ends there.
  void call(ImVec2 part, ImVec2 label, const std::string& text, bool right) const {
    if (text.empty()) return;
    line(part, label);
    const ImVec2 size = ImGui::CalcTextSize(text.c_str()), end = at(label.x, label.y);
    const float gap = 4 * ui::scale();
    m_draw.AddText({right ? end.x + gap : end.x - size.x - gap, end.y - 0.5f * size.y}, paint(ui::kWhite),
                   text.c_str());
  }

 private:
  ImDrawList& m_draw;
  ImVec2 m_at;
  float m_unit;
};

struct MouseWords {
  std::string left, right, wheel, move;
};

MouseWords mouse_words(const Equipment& e) {
  MouseWords w;
  w.move = e.hands > 0 ? tr("move: tip, or endoscope") : tr("move: turn the endoscope");
  w.wheel = tr("wheel: deeper, back");
  w.right = tr("right, dragged: roll");
  if (e.jaws)
    w.left = tr("left: close the jaws");
  else if (e.needle || e.valves)
    w.left = e.needle ? tr("left: draw the plunger") : tr("left: suction");
  return w;
}

void draw_mouse(const Sketch& s, const Equipment& e, bool left_handed) {
  const MouseWords words = mouse_words(e);
  const bool left = !words.left.empty();
  s.box(4.6f, 0.6f, 2.2f, 3.6f, kBody, 1);
  s.box(4.7f, 0.7f, 0.95f, 1.4f, (left_handed || left) ? kUsed : kPart, 0.4f);
  s.box(5.75f, 0.7f, 0.95f, 1.4f, (!left_handed || left) ? kUsed : kPart, 0.4f);
  s.box(5.55f, 0.95f, 0.3f, 0.8f, ui::kOrange, 0.15f);
  s.call({5, 1.2f}, {4.2f, 0.9f}, left_handed ? words.right : words.left, false);
  s.call({6.4f, 1.2f}, {7.2f, 0.9f}, left_handed ? words.left : words.right, true);
  s.call({5.7f, 1.4f}, {7.2f, 2.0f}, words.wheel, true);
  s.call({5.7f, 3.2f}, {7.2f, 3.2f}, words.move, true);
}

/// Does a line of help name this key, and does it apply here?
bool key_is_used(const Equipment& e, std::string_view key) {
  for (const devices::HelpLine& line : devices::help()) {
    if (line.device != devices::Device::keyboard || !e.has(line.needs)) continue;
    std::string words = std::string(" ") + line.keys + " ";
    for (char& c : words)
      if (c == ',') c = ' ';
    if (words.find(" " + std::string(key) + " ") != std::string::npos) return true;
  }
  return key == "P";
}

void draw_keyboard_key(const Sketch& s, const Equipment& e, float x, float y, float width, const char* key,
                       const char* name) {
  const bool used = key_is_used(e, key);
  s.box(x, y, width, 0.84f, used ? kUsed : kBody);
  s.name(x + 0.5f * width, y + 0.42f, name, used ? ui::kWhite : ImVec4{0.45f, 0.48f, 0.52f, 1});
}

void draw_keyboard(const Sketch& s, const Equipment& e, float top) {
  constexpr const char* kRows[] = {"1234567890", "QWERTYUIOP", "ASDFGHJKL", "ZXCVBNM"};
  constexpr float kIndent[] = {0.6f, 1.0f, 1.3f, 1.8f};
  for (int row = 0; row < 4; ++row)
    for (int i = 0; kRows[row][i] != 0; ++i) {
      const char key[2] = {kRows[row][i], 0};
      draw_keyboard_key(s, e, kIndent[row] + 0.92f * float(i), top + 0.92f * float(row), 0.84f, key, key);
    }
  draw_keyboard_key(s, e, 0, top + 2.76f, 1.7f, "Shift", "Shift");
  draw_keyboard_key(s, e, 2.7f, top + 3.68f, 4.2f, "Space", tr("Space"));
  draw_keyboard_key(s, e, 0, top + 0.92f, 0.92f, "Tab", "Tab");
  const float x = 9.4f, y = top + 3.22f;
  constexpr struct {
    const char *key, *name;
    float x, y;
  } kArrows[] = {{"Up", "\u2191", 0.92f, 0},
                 {"Left", "\u2190", 0, 0.92f},
                 {"Down", "\u2193", 0.92f, 0.92f},
                 {"Right", "\u2192", 1.84f, 0.92f}};
  for (const auto& arrow : kArrows) draw_keyboard_key(s, e, x + arrow.x, y + arrow.y, 0.84f, arrow.key, arrow.name);
}

}  // namespace

float draw_mouse_and_keys(const Equipment& equipment, bool left_handed, ImVec2 at, float width) {
  constexpr float kUnits = 12.4f, kHigh = 10.2f, kKeysTop = 4.9f;
  const Sketch s(at, width / kUnits);
  draw_mouse(s, equipment, left_handed);
  draw_keyboard(s, equipment, kKeysTop);
  return s.length(kHigh);
}

float draw_gamepad(const Equipment& e, ImVec2 at, float width) {
  constexpr float kUnits = 19, kAside = 1.5f, kHigh = 9.4f;
  const Sketch s({at.x + kAside * width / kUnits, at.y}, width / kUnits);
  const bool hands = e.hands > 0;
  s.box(4.2f, 2.4f, 7.6f, 3.6f, kBody, 1.4f);
  s.disc(4.9f, 5.6f, 1.5f, kBody);
  s.disc(11.1f, 5.6f, 1.5f, kBody);
  s.box(4.6f, 1.6f, 1.8f, 0.6f, hands ? kUsed : kPart, 0.2f);
  s.box(9.6f, 1.6f, 1.8f, 0.6f, hands ? kUsed : kPart, 0.2f);
  const bool triggers = hands || e.oblique;
  s.box(4.8f, 0.7f, 1.4f, 0.7f, triggers ? kUsed : kPart, 0.3f);
  s.box(9.8f, 0.7f, 1.4f, 0.7f, triggers ? kUsed : kPart, 0.3f);
  s.disc(5.6f, 3.6f, 0.75f, kUsed);
  s.disc(9.2f, 5, 0.75f, kUsed);
  s.box(6.4f, 4.85f, 1.2f, 0.4f, kPart, 0.1f);
  s.box(6.8f, 4.45f, 0.4f, 1.2f, kPart, 0.1f);
  constexpr struct {
    const char* name;
    float x, y;
  } kButtons[] = {{"A", 10.4f, 4.25f}, {"B", 11.1f, 3.55f}, {"X", 9.7f, 3.55f}, {"Y", 10.4f, 2.9f}};
  for (const auto& b : kButtons) {
    const bool used = b.name[0] == 'B' ? e.lens || e.declares : b.name[0] == 'A' ? e.energy || e.wrist : hands;
    s.disc(b.x, b.y, 0.36f, used ? kUsed : kPart);
    s.name(b.x, b.y, b.name);
  }
  s.call({5.2f, 1.0f}, {3.8f, 0.5f}, e.jaws ? tr("lock the jaws") : e.oblique ? tr("light post") : "", false);
  s.call({10.8f, 1.0f}, {12.2f, 0.5f}, e.jaws ? tr("close the jaws") : e.oblique ? tr("light post") : "", true);
  s.call({5.2f, 1.9f}, {3.8f, 1.7f}, hands ? tr("previous") : "", false);
  s.call({10.8f, 1.9f}, {12.2f, 1.7f}, hands ? tr("next instrument") : "", true);
  s.call({5.6f, 3.6f}, {3.8f, 3.4f}, hands ? tr("move the tip") : tr("turn the view"), false);
  s.call({9.2f, 5.0f}, {8.4f, 7.2f}, tr("deeper, back; sideways: roll"), true);
  s.call({10.4f, 2.9f}, {12.2f, 2.7f}, hands ? tr("Y: exchange") : "", true);
  s.call({11.1f, 3.55f}, {12.2f, 3.6f}, e.lens ? tr("B: wipe the lens") : "", true);
  s.call({10.4f, 4.25f}, {12.2f, 4.5f}, e.energy ? tr("A: coagulate") : "", true);
  s.call({9.7f, 3.55f}, {3.8f, 6.6f}, hands ? tr("X: into view") : "", false);
  return s.length(kHigh);
}

}  // namespace trocar::app

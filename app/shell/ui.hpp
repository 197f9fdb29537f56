// What all screens of the window share: colours, texts, buttons, marks. Thin over Dear ImGui.
//
// Meaning is never carried by colour alone: a done step is a blue tick, an error an orange triangle with "!", what is
// to be done now a white arrow; colours are those of [Okabe & Ito 2008], told apart with every kind of colour vision.
//
// Buttons and fields remember where they stand, so that a test that drives the real window finds them as an eye would:
// see take_widgets().
#pragma once

#include <string>
#include <vector>

#include <imgui.h>

namespace trocar::app::ui {

inline const ImVec4 kWhite{0.95f, 0.95f, 0.95f, 1}, kGrey{0.68f, 0.70f, 0.73f, 1}, kBlue{0.42f, 0.75f, 0.95f, 1},
    kOrange{0.95f, 0.66f, 0.10f, 1}, kRed{0.98f, 0.47f, 0.24f, 1}, kDark{0.09f, 0.10f, 0.12f, 1};

/// Fonts for this display, loaded anew. @param scale of texts and everything between them
void load_fonts(float scale);
float scale();  ///< as given last
ImFont* title_font();

/// In lines of at most `width` [px], broken at spaces only: Dear ImGui by itself makes two lines of "0." and "3 N".
std::string wrapped(const std::string& s, float width);
void text(const std::string& s, const ImVec4& colour = kWhite);  ///< wrapped
void title(const std::string& s, const ImVec4& colour = kWhite);
void heading(const std::string& s);  ///< a rule and a grey word
/// `s`, shortened with "..." to `width`.
std::string shortened(const std::string& s, float width);

enum class Mark { done, now, open, error, warning, note };
/// A mark as high as the text, then stays on the line.
void mark(Mark m);
void draw_mark(Mark m, ImVec2 at, float size);  ///< the mark alone [px]
ImVec4 colour_of(Mark m);

/// The middle button takes the first focus, so that Enter or the gamepad's A goes on.
struct ButtonLook {
  float width = 0, height = 0;  ///< 0: as wide as the text, one line and a half high [px at scale 1]
  bool primary = false, enabled = true;
  const char* tip = nullptr;
};
bool button(const std::string& label, const ButtonLook& look = {});
bool checkbox(const std::string& label, bool& value);
bool slider(const std::string& label, double& value, double low, double high, const char* format, bool logarithmic);

/// What comes next, `width` wide [px at scale 1], goes beside the last thing, or below it where there is no room.
void beside(float width);

/// The last thing drawn takes the focus of keys and gamepad.
void take_focus();

/// A window that covers everything, or one in the middle of what is `width` wide; end with ImGui::End().
void set_middle(float width);  ///< [px]; 0: the whole window
void begin_screen(const char* name);
void begin_middle(const char* name, float width);

/// Something on the screen: `id` is its label, x and y its middle [px].
struct Widget {
  std::string id;
  int x = 0, y = 0;
  bool focus = false;  ///< of keys and gamepad
  friend bool operator==(const Widget&, const Widget&) = default;
};
/// The last thing drawn is a widget named `id`.
void note_widget(const std::string& id);
/// Everything drawn since the last call.
std::vector<Widget> take_widgets();

/// The address opens in the system's browser. False: there is no way to.
bool open_in_browser(const std::string& path);

}  // namespace trocar::app::ui

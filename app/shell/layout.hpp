// How a window's picture is divided into panes, and what each of them shows.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "shell/area.hpp"

namespace trocar::app {

enum class Layout { one, side_by_side, corner, four };
struct LayoutName {
  const char* name;
  const char* meaning;
};
inline constexpr LayoutName kLayoutNames[] = {{"one", "one picture"},
                                              {"side-by-side", "two, side by side"},
                                              {"corner", "one, and a small one in its corner"},
                                              {"four", "four"}};
inline constexpr const char* name_of(Layout layout) { return kLayoutNames[std::size_t(layout)].name; }
inline constexpr Layout after(Layout layout) { return Layout((int(layout) + 1) % 4); }
inline constexpr int panes_in(Layout layout) { return layout == Layout::one ? 1 : layout == Layout::four ? 4 : 2; }

enum class PaneShows { endoscope, second_scope, outside, analysis };
inline constexpr LayoutName kPaneNames[] = {{"endoscope", "what the endoscope sees"},
                                            {"second-scope", "what a second endoscope sees"},
                                            {"outside", "the scene from outside"},
                                            {"analysis", "figures in colour"}};
inline constexpr const char* name_of(PaneShows shows) { return kPaneNames[std::size_t(shows)].name; }
inline constexpr int kMostPanes = 4;

template <std::size_t n>
std::vector<std::string> names_in(const LayoutName (&names)[n]) {
  std::vector<std::string> all;
  for (const LayoutName& name : names) all.push_back(name.name);
  return all;
}
/// The number of a name in its table; 0 where it is not there.
template <std::size_t n>
constexpr int number_of(const LayoutName (&names)[n], const std::string& name) {
  for (std::size_t i = 0; i < n; ++i)
    if (name == names[i].name) return int(i);
  return 0;
}

/// What each pane shows, the first one the large one. All different: what one takes, the other gives.
struct LayoutChoice {
  Layout layout = Layout::one;
  std::array<PaneShows, kMostPanes> panes{PaneShows::endoscope, PaneShows::outside, PaneShows::second_scope,
                                          PaneShows::analysis};

  std::optional<PaneShows> elsewhere = {};  ///< what the second window shows, if there is one

  int count() const { return panes_in(layout); }
  bool shows(PaneShows what) const {
    for (int i = 0; i < count(); ++i)
      if (panes[std::size_t(i)] == what) return true;
    return false;
  }
  /// Pane `i` shows that, and what it showed goes where that was.
  void put(int i, PaneShows what) {
    for (PaneShows& other : panes)
      if (other == what) other = panes[std::size_t(i)];
    panes[std::size_t(i)] = what;
  }
  friend bool operator==(const LayoutChoice&, const LayoutChoice&) = default;
};

/// The panes' places in `whole`, in whole pixels. @param scale  of texts: how wide the gaps are
std::vector<Area> areas_of(Layout layout, const Area& whole, float scale);

/// What a picture costs that draws the first of these panes and one of the others, beside one that draws one pane over
/// `whole`; for render::Governor::load_becomes().
double load_of(const std::vector<Area>& areas, const Area& whole);

}  // namespace trocar::app

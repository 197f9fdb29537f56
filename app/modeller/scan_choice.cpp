#include "modeller/scan_choice.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>

#include <trocar/core/text.hpp>

#include "shell/ui.hpp"

namespace trocar::app {
namespace {

std::string in_words(const volumes::SeriesFacts& series) {
  const std::string name = series.description.empty() ? std::string(tr("without a name")) : series.description;
  return tr("{}: {} slices of {} x {}, {}", name, series.size[2], series.size[0], series.size[1], series.detail);
}

std::string frame_in_words(const volumes::ReadReport& report, int frame) {
  const bool named = std::size_t(frame) < report.frame_names.size();
  return named ? fmt::format("{}: {}", frame, report.frame_names[std::size_t(frame)]) : tr("number {}", frame);
}

}  // namespace

std::optional<ScanWish> draw_series_dialogue(const std::string& file, const std::vector<volumes::SeriesFacts>& series,
                                             bool& open) {
  std::optional<ScanWish> chosen;
  ui::begin_middle("series", 640);
  ui::title(tr("Choose a series of {}", file));
  ui::text(tr("None of them is the whole. Each is opened on its own."), ui::kGrey);
  constexpr float kMostRows = 12;
  const float rows = std::min(kMostRows, float(series.size()));
  ImGui::BeginChild("list", {0, rows * ImGui::GetFrameHeightWithSpacing()}, false);
  for (std::size_t s = 0; s < series.size(); ++s) {
    const std::string row = fmt::format("{}. {}##{}", s + 1, in_words(series[s]), s);
    if (ImGui::Selectable(row.c_str(), false)) chosen = ScanWish{int(s) + 1, {}};
    ui::note_widget(fmt::format("series {}", s + 1));
  }
  ImGui::EndChild();
  if (ui::button(tr("Cancel"), {.width = 140})) open = false;
  ImGui::End();
  return chosen;
}

std::optional<ScanWish> draw_volume_lists(const volumes::ReadReport& report) {
  std::optional<ScanWish> chosen;
  if (report.series.size() > 1) {
    const std::size_t now = std::size_t(std::max(1, report.chosen_series) - 1);
    ImGui::SetNextItemWidth(170 * ui::scale());
    if (ImGui::BeginCombo(tr("series"), in_words(report.series[now]).c_str(), ImGuiComboFlags_HeightLarge)) {
      for (std::size_t s = 0; s < report.series.size(); ++s) {
        const std::string row = fmt::format("{}. {}##{}", s + 1, in_words(report.series[s]), s);
        if (ImGui::Selectable(row.c_str(), s == now) && s != now) chosen = ScanWish{int(s) + 1, {}};
        ui::note_widget(fmt::format("listed series {}", s + 1));
      }
      ImGui::EndCombo();
    } else {
      ui::note_widget("series");
    }
  }
  if (report.frames > 1) {
    ImGui::SetNextItemWidth(170 * ui::scale());
    if (ImGui::BeginCombo(tr("time point"), frame_in_words(report, report.frame).c_str())) {
      for (int f = 0; f < report.frames; ++f) {
        const std::string row = fmt::format("{}##{}", frame_in_words(report, f), f);
        if (ImGui::Selectable(row.c_str(), f == report.frame) && f != report.frame)
          chosen = ScanWish{report.chosen_series, f};
        ui::note_widget(fmt::format("time point {}", f));
      }
      ImGui::EndCombo();
    } else {
      ui::note_widget("time point");
    }
  }
  return chosen;
}

}  // namespace trocar::app

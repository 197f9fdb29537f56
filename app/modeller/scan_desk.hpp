// A patient's scan in the window: three slices that move with a cross, the block, and tools that draw segments into it.
//
//   ScanDesk desk;
//   desk.open("patient/series");                     // reads beside the window
//   if (desk.shows()) desk.draw(area, panel);        // instead of the document's views and properties
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <trocar/core/parallel.hpp>
#include <trocar/modeller/scan/scan.hpp>
#include <trocar/view/base/cameras.hpp>
#include <trocar/volumes/show/caster.hpp>
#include <trocar/volumes/show/slice_image.hpp>

#include "modeller/scan_choice.hpp"
#include "shell/area.hpp"

namespace trocar::app {

/// What a press in a slice does.
enum class ScanTool { look, paint, erase, threshold, grow, islands };

/// A line for the user: what was done, or why it could not be.
struct ScanMessage {
  std::string text;
  bool error = false;
};

/// Segments that were kept when a modeller ended.
struct LostSegments {
  std::filesystem::path scan, labels;
};
/// None: nothing was kept in the folder, or it cannot be read.
std::optional<LostSegments> lost_segments(const std::filesystem::path& folder);

class ScanDesk {
 public:
  ScanDesk();
  ~ScanDesk();
  ScanDesk(const ScanDesk&) = delete;
  ScanDesk& operator=(const ScanDesk&) = delete;

  /// Begins to read; what was there stays until it is there.
  /// @param labels  a label map that is taken in with it; empty: none
  void open(const std::filesystem::path& path, const std::filesystem::path& labels = {}, const ScanWish& wish = {});
  /// Must the user choose one of several series? Then the dialogue is on top of everything.
  bool asks() const { return m_asked.has_value(); }
  void draw_choice();
  void end_choice() { m_asked.reset(); }
  /// Writes the segments where a crash leaves them, beside the window, some seconds after they changed.
  void keep(const std::filesystem::path& folder);
  /// Nothing is to be offered after the next start.
  static void forget(const std::filesystem::path& folder);
  void take_labels(const std::filesystem::path& path);
  void write_labels(const std::filesystem::path& path);
  void close();
  bool reads() const { return m_reading.valid(); }
  bool shows() const { return m_scan != nullptr; }

  /// Slices and block into `middle`, tools into `panel`; takes what has been read.
  void draw(const Area& middle, const Area& panel);
  /// Keys of segment editors: digits choose tools, + and - the brush. False: the key means nothing here.
  bool obey_key(int key, int mods);
  void undo();
  void redo();

  modeller::Scan& scan() { return *m_scan; }
  /// A line about what has happened, once.
  ScanMessage take_message() { return std::exchange(m_message, {}); }
  /// A segment that is to become an organ; empty: none.
  std::string take_wanted_organ() { return std::exchange(m_wanted_organ, {}); }
  std::string chosen_segment() const;

 private:
  struct Pane;
  struct Asked {
    std::filesystem::path path, labels;
    std::vector<volumes::SeriesFacts> series;
  };
  void take_what_was_read();
  void draw_slice(Pane& pane, const Area& area, int which);
  void draw_block(const Area& area);
  void draw_panel(const Area& panel);
  void draw_view_settings();
  void draw_segments();
  void draw_tools();
  void draw_range();
  void draw_whole_segment();
  void press_tool(const Vec3d& at, const volumes::Index3& voxel, const volumes::SlicePlane& plane, bool fresh);
  void tint(volumes::Picture& picture, const volumes::SlicePlane& plane) const;
  void preview_growth();
  void apply_growth();
  void say(std::string text) { m_message = {std::move(text), false}; }
  void refuse(std::string text) { m_message = {std::move(text), true}; }
  bool range_is_in_use() const { return m_tool == ScanTool::threshold || m_tool == ScanTool::grow; }
  void press(const Vec3d& at, const volumes::SlicePlane& plane, bool fresh);
  void tool_button(const char* label, ScanTool tool);
  template <class Make>
  void edit(const char* name, Make&& make);
  std::uint16_t label();
  const std::vector<std::size_t>& voxels();  ///< of each label

  std::unique_ptr<modeller::Scan> m_scan;
  std::future<std::unique_ptr<modeller::Scan>> m_reading;
  std::filesystem::path m_reads, m_reads_labels;  ///< what is being read
  bool m_keeps_labels = false;                    ///< another volume of what is shown is being read
  std::optional<Asked> m_asked;
  std::atomic<double> m_share{0};
  std::atomic<bool> m_stop{false};
  ScanMessage m_message;
  std::string m_wanted_organ, m_segment = "organ";
  std::array<std::unique_ptr<Pane>, 4> m_panes;
  Vec3d m_cross;                                 ///< [mm, L P S]
  std::optional<double> m_under;                 ///< the value under the pointer
  bool m_is_ct = true;                           ///< values are Hounsfield units
  std::optional<volumes::Index3> m_seed;         ///< where growth begins
  std::optional<volumes::LabelChange> m_growth;  ///< what Apply would do
  double m_centre = 40, m_width = 400, m_from = 0, m_to = 200, m_brush = 8, m_margin = 2;
  ScanTool m_tool = ScanTool::look;
  std::vector<Vec3d> m_stroke;        ///< [mm, L P S] painted with the button that is held
  std::vector<std::size_t> m_voxels;  ///< of each label, in this version of them
  std::uint64_t m_counted = ~0ull;
  std::uint64_t m_look = 0;  ///< another number: slices look otherwise

  core::ThreadPool m_pool;
  std::unique_ptr<volumes::VolumeCaster> m_caster;
  std::uint64_t m_cast_labels = ~0ull;
  volumes::TransferFunction m_transfer;
  double m_low = -1000, m_high = 1500;  ///< values between which it is edited
  int m_chosen_point = -1;
  std::future<void> m_keeping;
  std::uint64_t m_kept = 0;
  std::chrono::steady_clock::time_point m_kept_at{};
  view::Orbit m_orbit;
  int m_preset = 3;
  bool m_labels_shown = true, m_turning = false;
  std::uint64_t m_block_wanted = 1, m_block_drawn = 0;
  bool m_block_full = false;
  volumes::QualityGovernor m_governor{60};
  double m_block_ms = 0;
};

}  // namespace trocar::app

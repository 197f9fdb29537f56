#include "modeller/scan_desk.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <epoxy/gl.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/text.hpp>
#include <trocar/modeller/scan/value_presets.hpp>
#include <trocar/volumes/files/volume_writer.hpp>
#include <trocar/volumes/segment/brush.hpp>
#include <trocar/volumes/segment/islands.hpp>
#include <trocar/volumes/segment/shape_tools.hpp>
#include <trocar/volumes/segment/threshold.hpp>

#include "modeller/transfer_panel.hpp"
#include "shell/ui.hpp"

namespace trocar::app {
namespace {

constexpr const char *kPlanes[] = {"Axial", "Sagittal", "Coronal"},
                     *kLooks[] = {"Bone", "Skin", "Vessels", "Soft tissue"};
constexpr double kBlockTurn = 0.008;  // [rad/px]

}  // namespace

/// A picture in a texture.
struct ScanDesk::Pane {
  unsigned texture = 0;
  volumes::SlicePlane plane;
  std::uint64_t drawn = ~0ull;
  int width = 0, height = 0;

  ~Pane() {
    if (texture != 0) glDeleteTextures(1, &texture);
  }
  void take(const volumes::Picture& picture) {
    if (texture == 0) glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, picture.width, picture.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                 picture.rgba.data());
    width = picture.width;
    height = picture.height;
  }
};

ScanDesk::ScanDesk() : m_pool(core::default_thread_count()) {
  for (auto& pane : m_panes) pane = std::make_unique<Pane>();
}

ScanDesk::~ScanDesk() {
  m_stop = true;
  if (m_reading.valid()) m_reading.wait();
  if (m_keeping.valid()) m_keeping.wait();
}

void ScanDesk::open(const std::filesystem::path& path, const std::filesystem::path& labels, const ScanWish& wish) {
  if (m_reading.valid()) return;
  m_share = 0;
  m_stop = false;
  m_reads = path;
  m_reads_labels = labels;
  m_keeps_labels = false;
  m_reading = std::async(std::launch::async, [this, path, labels, wish] {
    volumes::ReadOptions options;
    options.series = wish.series;
    options.frame = wish.frame;
    options.series_choice = tr("the list \"series\"");
    options.frame_choice = tr("the list \"time point\"");
    options.progress = [this](double share) {
      m_share = share;
      return !m_stop;
    };
    auto scan = std::make_unique<modeller::Scan>(modeller::Scan::open(path, options));
    if (!labels.empty()) scan->take_labels(labels);
    return scan;
  });
}

namespace {

constexpr auto kKeepEvery = std::chrono::seconds(8);
constexpr const char *kKeptLabels = "segments.seg.nrrd", *kKeptNote = "segments.txt";

}  // namespace

void ScanDesk::keep(const std::filesystem::path& folder) {
  const auto now = std::chrono::steady_clock::now();
  if (!m_scan || m_scan->version() == m_kept || now - m_kept_at < kKeepEvery) return;
  if (m_keeping.valid() && m_keeping.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  m_kept = m_scan->version();
  m_kept_at = now;
  m_keeping = std::async(std::launch::async, [folder, labels = m_scan->labels(), path = m_scan->path()] {
    try {
      std::error_code ignored;
      std::filesystem::create_directories(folder, ignored);
      volumes::write_labels(folder / kKeptLabels, labels);
      const std::string text = std::filesystem::absolute(path, ignored).generic_string();
      core::write_file(folder / kKeptNote, text.data(), text.size(), 0600);
    } catch (const core::BadInput&) {  // a full disk: the next time again
    }
  });
}

void ScanDesk::forget(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::filesystem::remove(folder / kKeptNote, ignored);
  std::filesystem::remove(folder / kKeptLabels, ignored);
}

std::optional<LostSegments> lost_segments(const std::filesystem::path& folder) {
  try {
    constexpr std::uint64_t kLongestPath = 4096;
    LostSegments lost{core::read_file(folder / kKeptNote, kLongestPath), folder / kKeptLabels};
    std::error_code error;
    if (std::filesystem::exists(lost.scan, error) && std::filesystem::exists(lost.labels, error)) return lost;
  } catch (const core::BadInput&) {
  }
  return std::nullopt;
}

void ScanDesk::take_what_was_read() {
  if (!m_reading.valid() || m_reading.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  std::vector<std::string> notes;
  try {
    std::unique_ptr<modeller::Scan> read = m_reading.get();
    if (m_keeps_labels && m_scan) notes = read->take_labels(m_scan->labels());
    m_caster.reset();
    m_scan = std::move(read);
  } catch (const volumes::SeriesChoice& choice) {
    m_asked = Asked{m_reads, m_reads_labels, choice.series()};
    return;
  } catch (const core::BadInput& bad) {
    refuse(bad.faults().front().message);
    return;
  } catch (const std::exception& failed) {  // cancelled, or a library that is lacking
    refuse(failed.what());
    return;
  }
  const volumes::Volume& v = m_scan->volume();
  const geometry::Bounds box = volumes::patient_box(v.grid);
  m_cross = (box.low + box.high) / 2.0;
  // CT where nobody says the unit, as in NIfTI: only Hounsfield's scale has air at -1000
  const volumes::Statistics values = volumes::statistics(v);
  const bool is_ct = v.unit == "HU" || (values.least <= -900 && values.greatest < 5000);
  if (!is_ct) {  // no known unit: the window is where the values are
    const double low = volumes::quantile(v, 0.02), high = volumes::quantile(v, 0.99);
    m_centre = (low + high) / 2;
    m_width = std::max(1.0, high - low);
    m_from = m_centre;
    m_to = high;
  }
  m_is_ct = is_ct;
  m_seed.reset();
  m_growth.reset();
  m_caster = std::make_unique<volumes::VolumeCaster>(v, m_pool);
  m_counted = ~0ull;
  m_transfer = is_ct ? volumes::transfer_preset(volumes::TransferPreset(m_preset))
                     : volumes::grey_ramp(m_centre - m_width / 2, m_centre + m_width / 2);
  m_caster->set_transfer(m_transfer);
  m_low = is_ct ? -1000 : values.least;
  m_high = is_ct ? 1500 : values.greatest;
  m_chosen_point = -1;
  m_kept = m_scan->version();
  m_orbit.target = volumes::scene_from_patient(m_cross);
  m_orbit.distance = 1.6e-3 * length(box.high - box.low);
  m_orbit.yaw = 0.3;
  m_orbit.pitch = 0.6;
  m_cast_labels = ~0ull;
  ++m_look, ++m_block_wanted;
  say(tr("{} x {} x {} voxels of {:.2f} x {:.2f} x {:.2f} mm", v.grid.size[0], v.grid.size[1], v.grid.size[2],
         v.grid.spacing.x, v.grid.spacing.y, v.grid.spacing.z));
  for (const std::string& note : notes) m_message.text += "; " + note;
  for (const std::string& note : m_scan->report().notes) m_message.text += "; " + note;
}

void ScanDesk::draw_choice() {
  if (!m_asked) return;
  bool stays = true;
  const Asked asked = *m_asked;
  const std::optional<ScanWish> wish = draw_series_dialogue(asked.path.filename().string(), asked.series, stays);
  if (!wish && stays) return;
  m_asked.reset();
  if (wish) open(asked.path, asked.labels, *wish);
}

void ScanDesk::take_labels(const std::filesystem::path& path) {
  if (!m_scan) return;
  for (const std::string& note : m_scan->take_labels(path)) say(note);
  if (!m_scan->labels().segments.empty()) m_segment = m_scan->labels().segments.front().name;
}

void ScanDesk::write_labels(const std::filesystem::path& path) {
  if (!m_scan) return;
  volumes::write_labels(path, m_scan->labels());
  say(tr("Saved: {}", path.string()));
}

void ScanDesk::close() {
  m_caster.reset();
  m_scan.reset();
}

void ScanDesk::undo() { say(m_scan->undo() ? tr("Undone.") : tr("There is nothing to undo.")); }
void ScanDesk::redo() { say(m_scan->redo() ? tr("Done again.") : tr("There is nothing to redo.")); }

std::uint16_t ScanDesk::label() { return m_scan->segment(m_segment); }
std::string ScanDesk::chosen_segment() const { return m_segment; }

/// Counted anew only where that is not known from the change itself: a scan has many voxels, and a stroke many dabs.
const std::vector<std::size_t>& ScanDesk::voxels() {
  if (m_counted != m_scan->version()) m_voxels = volumes::voxels_per_label(m_scan->labels());
  m_counted = m_scan->version();
  return m_voxels;
}

/// Whatever a tool cannot do is a message: nothing that is done here ends the program.
template <class Make>
void ScanDesk::edit(const char* name, Make&& make) {
  try {
    const std::uint16_t of = label();
    const double voxel = m_scan->volume().grid.voxel_ml(), before = voxel * double(voxels()[of]);
    const volumes::LabelChange change = make(of);
    if (change.empty()) return say(tr("{}: nothing changed, {} has {:.2f} mL.", name, m_segment, before));
    m_scan->change(name, change);
    for (const volumes::LabelRun& run : change.runs) {
      m_voxels[run.from] -= run.count;
      m_voxels[run.to] += run.count;
    }
    m_counted = m_scan->version();
    m_growth.reset();
    say(tr("{}: {} has {:.2f} mL (before: {:.2f} mL).", name, m_segment, voxel * double(m_voxels[of]), before));
  } catch (const core::BadInput& bad) {
    refuse(bad.faults().front().message);
  } catch (const std::exception& failed) {
    refuse(tr("{}: {}", name, failed.what()));
  }
}

bool ScanDesk::obey_key(int key, int mods) {
  if (mods & GLFW_MOD_CONTROL) {
    if (key == GLFW_KEY_Z) mods& GLFW_MOD_SHIFT ? redo() : undo();
    return key == GLFW_KEY_Z;
  }
  if (key >= GLFW_KEY_1 && key <= GLFW_KEY_6) {
    m_tool = ScanTool(key - GLFW_KEY_1);
    m_growth.reset();
    ++m_look;
    return true;
  }
  if ((key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER) && m_growth) {
    apply_growth();
    return true;
  }
  if (key == GLFW_KEY_ESCAPE) m_tool = ScanTool::look, m_growth.reset(), ++m_look;
  if (key == GLFW_KEY_KP_ADD || key == GLFW_KEY_EQUAL) m_brush = std::min(100.0, 1.25 * m_brush);
  if (key == GLFW_KEY_KP_SUBTRACT || key == GLFW_KEY_MINUS) m_brush = std::max(0.5, m_brush / 1.25);
  return key == GLFW_KEY_ESCAPE;
}

/// What the chosen tool does at a place of a slice.
void ScanDesk::press(const Vec3d& at, const volumes::SlicePlane& plane, bool fresh) {
  const volumes::Volume& v = m_scan->volume();
  const volumes::Index3 voxel = v.grid.nearest(at);
  if (m_tool == ScanTool::look || !v.grid.has(voxel)) {
    m_cross = at;
    ++m_look;
    return;
  }
  press_tool(at, voxel, plane, fresh);
}

void ScanDesk::press_tool(const Vec3d& at, const volumes::Index3& voxel, const volumes::SlicePlane& plane, bool fresh) {
  const volumes::Volume& v = m_scan->volume();
  const volumes::Labels& labels = m_scan->labels();
  if (m_tool == ScanTool::paint || m_tool == ScanTool::erase) {
    const bool erases = m_tool == ScanTool::erase;
    if (!m_stroke.empty() && length(at - m_stroke.back()) < 0.25 * m_brush) return;
    std::vector<Vec3d> way{at};
    if (!fresh && !m_stroke.empty()) way.insert(way.begin(), m_stroke.back());
    m_stroke.push_back(at);
    edit(erases ? tr("Erase") : tr("Paint"), [&](std::uint16_t of) {
      volumes::EditRules rules;
      if (erases) rules.inside = of;
      volumes::Brush brush;
      brush.radius_mm = m_brush;
      brush.normal = plane.normal();
      if (ImGui::GetIO().KeyShift) brush.normal.reset();  // a ball
      return volumes::painted(v, labels, way, brush, erases ? std::uint16_t(0) : of, rules);
    });
    return;
  }
  if (!fresh) return;
  if (m_tool == ScanTool::grow) {
    m_seed = voxel;
    preview_growth();
  }
  if (m_tool == ScanTool::islands)
    edit(tr("Keep this island"), [&](std::uint16_t of) { return volumes::chosen_kept(v, labels, of, voxel); });
  if (m_tool == ScanTool::threshold) {  // the value there is in the middle
    const double value = v.value(voxel), half = (m_to - m_from) / 2;
    m_from = value - half;
    m_to = value + half;
    ++m_look;
  }
}

/// What Grow would take from its seed; a seed outside the range is refused with its value.
void ScanDesk::preview_growth() {
  m_growth.reset();
  ++m_look;
  const volumes::Volume& v = m_scan->volume();
  if (!m_seed || !v.grid.has(*m_seed)) return;
  const double value = v.value(*m_seed);
  if (value < m_from || value > m_to)
    return refuse(
        tr("The value here is {:.0f} {}, outside the range {:.0f} to {:.0f}. Change the range, or click "
           "another place.",
           value, v.unit, m_from, m_to));
  try {
    const volumes::Index3 seed = *m_seed;
    m_growth = volumes::grown(v, m_scan->labels(), std::span(&seed, 1), {m_from, m_to}, label());
    say(tr("Grow would add {:.1f} mL. Press Apply or Enter.", v.grid.voxel_ml() * double(m_growth->voxels())));
  } catch (const std::exception& failed) {
    refuse(failed.what());
  }
}

void ScanDesk::apply_growth() {
  if (!m_growth) return;
  const volumes::LabelChange change = *m_growth;
  edit(tr("Grow"), [&](std::uint16_t) { return change; });
  m_seed.reset();
}

/// Voxels of the range in orange; what Grow would take in green.
void ScanDesk::tint(volumes::Picture& picture, const volumes::SlicePlane& plane) const {
  const volumes::Volume& v = m_scan->volume();
  const volumes::Grid& grid = v.grid;
  const auto is_taken = [this](std::size_t voxel) {
    const auto& runs = m_growth->runs;
    auto run = std::upper_bound(runs.begin(), runs.end(), voxel,
                                [](std::size_t at, const volumes::LabelRun& r) { return at < r.first; });
    return run != runs.begin() && voxel < std::size_t((--run)->first) + run->count;
  };
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const Vec3d place = plane.at(x, y);
      std::uint8_t* p = picture.rgba.data() + 4 * (std::size_t(y) * std::size_t(picture.width) + std::size_t(x));
      const volumes::Index3 voxel = grid.nearest(place);
      if (m_growth && grid.has(voxel) && is_taken(grid.index(voxel))) {
        p[0] = std::uint8_t(p[0] / 2), p[1] = std::uint8_t((p[1] + 255) / 2), p[2] = std::uint8_t((p[2] + 120) / 2);
      } else if (const double value = v.at(grid.to_index(place)); value >= m_from && value <= m_to) {
        p[0] = std::uint8_t((p[0] + 255) / 2), p[1] = std::uint8_t((p[1] + 160) / 2);
      }
    }
}

void ScanDesk::draw_slice(Pane& pane, const Area& area, int which) {
  const volumes::Grid& grid = m_scan->volume().grid;
  const std::uint64_t wanted = m_look * 1000003 + m_scan->version();
  if (pane.drawn != wanted) {
    pane.plane = which == 0   ? volumes::axial(grid, m_cross)
                 : which == 1 ? volumes::sagittal(grid, m_cross)
                              : volumes::coronal(grid, m_cross);
    volumes::SliceLook look;
    look.centre = m_centre;
    look.width = m_width;
    volumes::Picture picture =
        volumes::slice_image(m_scan->volume(), m_labels_shown ? &m_scan->labels() : nullptr, pane.plane, look);
    if (range_is_in_use()) tint(picture, pane.plane);
    pane.take(picture);
    pane.drawn = wanted;
  }
  // the whole slice in its pane, pixels square
  const float scale = std::min(area.width / float(pane.width), area.height / float(pane.height));
  const float w = scale * float(pane.width), h = scale * float(pane.height);
  const float x0 = area.x + (area.width - w) / 2, y0 = area.y + (area.height - h) / 2;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddRectFilled({area.x, area.y}, {area.x + area.width, area.y + area.height}, IM_COL32(0, 0, 0, 255));
  list.AddImage(ImTextureID(std::intptr_t(pane.texture)), {x0, y0}, {x0 + w, y0 + h});
  const Vec3d off = m_cross - pane.plane.corner;
  const float cx = x0 + scale * float(dot(off, pane.plane.right) / dot(pane.plane.right, pane.plane.right));
  const float cy = y0 + scale * float(dot(off, pane.plane.down) / dot(pane.plane.down, pane.plane.down));
  list.AddLine({x0, cy}, {x0 + w, cy}, IM_COL32(107, 191, 242, 120));
  list.AddLine({cx, y0}, {cx, y0 + h}, IM_COL32(107, 191, 242, 120));
  list.AddText({area.x + 8, area.y + 6}, IM_COL32(210, 214, 220, 255), tr(kPlanes[which]));
  list.AddRect({area.x, area.y}, {area.x + area.width, area.y + area.height}, IM_COL32(60, 64, 70, 255));
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantCaptureMouse || !area.holds(io.MousePos.x, io.MousePos.y)) return;
  const Vec3d at = pane.plane.at((io.MousePos.x - x0) / scale, (io.MousePos.y - y0) / scale);
  if (const volumes::Index3 voxel = grid.nearest(at); grid.has(voxel)) {
    m_under = m_scan->volume().value(voxel);
    list.AddText({area.x + 8, area.y + area.height - 26}, IM_COL32(255, 255, 255, 255),
                 tr("{:.0f} {}", *m_under, m_scan->volume().unit).c_str());
  }
  if (m_tool == ScanTool::paint || m_tool == ScanTool::erase)
    list.AddCircle(io.MousePos, float(m_brush / length(pane.plane.right)) * scale, IM_COL32(242, 168, 26, 255), 48,
                   1.4f);
  if (io.MouseWheel != 0) {
    if (io.KeyShift)
      m_brush = std::clamp(m_brush * std::exp(0.15 * io.MouseWheel), 0.5, 100.0);
    else
      m_cross += pane.plane.normal() * (io.MouseWheel * (which == 0 ? grid.spacing.z : grid.spacing.x)), ++m_look;
  }
  if (io.MouseDown[1]) {  // window and level, as everywhere
    m_width = std::clamp(m_width * std::exp(0.005 * io.MouseDelta.x), 1.0, 100000.0);
    m_centre -= 0.002 * m_width * io.MouseDelta.y;
    ++m_look;
  }
  if (io.MouseClicked[0]) m_stroke.clear();
  if (io.MouseDown[0]) press(at, pane.plane, io.MouseClicked[0]);
}

void ScanDesk::draw_block(const Area& area) {
  Pane& pane = *m_panes[3];
  const ImGuiIO& io = ImGui::GetIO();
  const bool over = !io.WantCaptureMouse && area.holds(io.MousePos.x, io.MousePos.y);
  if (over && (io.MouseDown[0] || io.MouseDown[1]) && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
    m_orbit.turn(-io.MouseDelta.x * kBlockTurn, io.MouseDelta.y * kBlockTurn);
    ++m_block_wanted;
  }
  if (over && io.MouseWheel != 0) m_orbit.zoom(std::exp(-0.12 * io.MouseWheel)), ++m_block_wanted;
  const bool painting = io.MouseDown[0] && !over;
  if (m_cast_labels != m_scan->version() && !painting) {
    m_caster->set_labels(m_labels_shown ? &m_scan->labels() : nullptr);
    m_cast_labels = m_scan->version();
    ++m_block_wanted;
  }
  const bool moves = m_block_drawn != m_block_wanted;
  if (moves || !m_block_full) {
    volumes::View view;
    view.eye = m_orbit.eye();
    view.target = m_orbit.target;
    view.up = {0, 0, 1};
    view.width = std::max(16, int(area.width));
    view.height = std::max(16, int(area.height));
    const volumes::Rendered r = m_caster->render(view, moves ? m_governor.quality() : volumes::Quality{});
    if (moves) m_governor.took(r.milliseconds);
    m_block_ms = r.milliseconds;
    m_block_full = !moves;
    m_block_drawn = m_block_wanted;
    pane.take(r.picture);
  }
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddRectFilled({area.x, area.y}, {area.x + area.width, area.y + area.height}, IM_COL32(18, 20, 24, 255));
  list.AddImage(ImTextureID(std::intptr_t(pane.texture)), {area.x, area.y},
                {area.x + area.width, area.y + area.height});
  list.AddText({area.x + 8, area.y + 6}, IM_COL32(210, 214, 220, 255), tr("3D view"));
  list.AddRect({area.x, area.y}, {area.x + area.width, area.y + area.height}, IM_COL32(60, 64, 70, 255));
}

void ScanDesk::tool_button(const char* text, ScanTool tool) {
  if (ui::button(text, {.width = 92, .primary = m_tool == tool})) m_tool = tool, m_growth.reset(), ++m_look;
}

void ScanDesk::draw_view_settings() {
  bool changed = ui::slider(tr("window centre"), m_centre, -1000, 3000, "%.0f", false);
  changed = ui::slider(tr("window width"), m_width, 1, 4000, "%.0f", true) || changed;
  if (changed) ++m_look;
  ImGui::SetNextItemWidth(170 * ui::scale());
  if (ImGui::BeginCombo(tr("3D view"), tr(kLooks[m_preset]))) {
    for (int i = 0; i < 4; ++i)
      if (ImGui::Selectable(tr(kLooks[i]), i == m_preset)) {
        m_preset = i;
        m_transfer = volumes::transfer_preset(volumes::TransferPreset(i));
        m_caster->set_transfer(m_transfer);
        ++m_block_wanted;
      }
    ImGui::EndCombo();
  }
  if (ImGui::TreeNode(tr("Opacity of the 3D view"))) {
    if (draw_transfer(m_transfer, m_low, m_high, m_chosen_point)) {
      m_caster->set_transfer(m_transfer);
      ++m_block_wanted;
    }
    ImGui::TreePop();
  }
}

void ScanDesk::draw_segments() {
  const volumes::Volume& v = m_scan->volume();
  ui::heading(tr("Segments"));
  if (ui::checkbox(tr("show segments"), m_labels_shown)) ++m_look, m_cast_labels = ~0ull;
  const float rows = std::min(7.0f, 0.5f + float(m_scan->labels().segments.size()));
  ImGui::BeginChild("segments", {0, rows * ImGui::GetTextLineHeightWithSpacing()});
  for (const volumes::Segment& s : m_scan->labels().segments) {
    ImGui::ColorButton(("##colour" + s.name).c_str(), ImVec4(s.colour[0], s.colour[1], s.colour[2], 1),
                       ImGuiColorEditFlags_NoTooltip, {14, 14});
    ImGui::SameLine();
    const double mL = v.grid.voxel_ml() * double(voxels()[s.label]);
    if (ImGui::Selectable(fmt::format("{}##{}", tr("{}  {:.1f} mL", s.name, mL), s.label).c_str(), s.name == m_segment))
      m_segment = s.name;
    ui::note_widget("segment " + s.name);
  }
  ImGui::EndChild();
  char name[64];
  std::snprintf(name, sizeof name, "%s", m_segment.c_str());
  ImGui::SetNextItemWidth(170 * ui::scale());
  if (ImGui::InputText(tr("draw into"), name, sizeof name) && name[0] != 0) m_segment = name;
  ui::note_widget("segment name");
}

void ScanDesk::draw_tools() {
  ui::heading(tr("Tools"));
  tool_button(tr("1 Look"), ScanTool::look);
  ImGui::SameLine();
  tool_button(tr("2 Paint"), ScanTool::paint);
  ImGui::SameLine();
  tool_button(tr("3 Erase"), ScanTool::erase);
  tool_button(tr("4 Threshold"), ScanTool::threshold);
  ImGui::SameLine();
  tool_button(tr("5 Grow"), ScanTool::grow);
  ImGui::SameLine();
  tool_button(tr("6 Island"), ScanTool::islands);
  if (m_tool == ScanTool::paint || m_tool == ScanTool::erase)
    ui::slider(tr("brush (mm)"), m_brush, 0.5, 60, "%.1f", true);
  if (range_is_in_use()) draw_range();
}

/// The range of values of Threshold and Grow, and what Apply does.
void ScanDesk::draw_range() {
  bool changed = false;
  ImGui::SetNextItemWidth(170 * ui::scale());
  if (m_is_ct && ImGui::BeginCombo(tr("preset"), tr("choose"))) {
    for (const modeller::ValuePreset& p : modeller::kValuePresets) {
      if (ImGui::Selectable(tr("{}: {:.0f} to {:.0f} HU", tr(p.name), p.from, p.to).c_str()))
        m_from = p.from, m_to = p.to, changed = true;
      ui::note_widget(std::string("preset ") + p.name);
    }
    ImGui::EndCombo();
  } else if (m_is_ct) {
    ui::note_widget("preset");
  }
  changed = ui::slider(tr("from"), m_from, -1024, 3071, "%.0f", false) || changed;
  changed = ui::slider(tr("to"), m_to, -1024, 3071, "%.0f", false) || changed;
  if (changed) {
    ++m_look;
    if (m_tool == ScanTool::grow && m_seed) preview_growth();
  }
  const bool grows = m_tool == ScanTool::grow;
  ui::text(
      grows ? tr("Click into the organ. Green: what Apply adds. Orange: the range.") : tr("Orange: what Apply adds."),
      ui::kGrey);
  if (!ui::button(tr("Apply"), {.width = 120, .primary = true, .enabled = !grows || m_growth.has_value()})) return;
  if (grows) return apply_growth();
  edit(tr("Threshold"), [&](std::uint16_t of) {
    return volumes::thresholded(m_scan->volume(), m_scan->labels(), {m_from, m_to}, of);
  });
}

void ScanDesk::draw_whole_segment() {
  const volumes::Labels& labels = m_scan->labels();
  if (!ImGui::TreeNodeEx(tr("Change the whole segment"), ImGuiTreeNodeFlags_DefaultOpen)) return;
  if (ui::button(tr("Largest part"), {.width = 132}))
    edit(tr("Largest part"), [&](std::uint16_t of) { return volumes::largest_kept(m_scan->volume(), labels, of); });
  ImGui::SameLine();
  if (ui::button(tr("Fill holes"), {.width = 132}))
    edit(tr("Fill holes"), [&](std::uint16_t of) { return volumes::holes_filled(m_scan->volume(), labels, of); });
  if (ui::button(tr("Smooth"), {.width = 132}))
    edit(tr("Smooth"), [&](std::uint16_t of) {
      return volumes::smoothed(m_scan->volume(), labels, of, 3, volumes::Smoothing::keeps_volume).change;
    });
  ImGui::SameLine();
  if (ui::button(tr("Between slices"), {.width = 132}))
    edit(tr("Between slices"),
         [&](std::uint16_t of) { return volumes::filled_between_slices(m_scan->volume(), labels, of, 2); });
  ui::slider(tr("margin (mm)"), m_margin, 0.5, 20, "%.1f", true);
  if (ui::button(tr("Add margin"), {.width = 132}))
    edit(tr("Add margin"),
         [&](std::uint16_t of) { return volumes::margin_moved(m_scan->volume(), labels, of, m_margin); });
  ImGui::SameLine();
  if (ui::button(tr("Remove margin"), {.width = 132}))
    edit(tr("Remove margin"),
         [&](std::uint16_t of) { return volumes::margin_moved(m_scan->volume(), labels, of, -m_margin); });
  ImGui::TreePop();
}

void ScanDesk::draw_panel(const Area& panel) {
  ImGui::SetNextWindowPos({panel.x, panel.y});
  ImGui::SetNextWindowSize({panel.width, panel.height});
  ImGui::Begin("scan", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoBringToFrontOnFocus);
  const volumes::Volume& v = m_scan->volume();
  // The last step stays in sight however low the window is.
  const float last = 2 * ImGui::GetFrameHeightWithSpacing() + 12 * ui::scale();
  ImGui::BeginChild("steps", {0, ImGui::GetContentRegionAvail().y - last}, false, ImGuiWindowFlags_NavFlattened);
  ui::title(tr("Scan"));
  ui::text(m_scan->path().filename().string(), ui::kGrey);
  if (const auto wish = draw_volume_lists(m_scan->report()); wish && !m_reading.valid()) {
    open(std::filesystem::path(m_scan->path()), {}, *wish);
    m_keeps_labels = true;
  }
  ui::text(m_under ? tr("Under the pointer: {:.0f} {}", *m_under, v.unit) : std::string(tr("Under the pointer: -")));
  draw_view_settings();
  draw_segments();
  draw_tools();
  draw_whole_segment();
  ImGui::EndChild();
  ui::heading(tr("Next"));
  if (ui::button(tr("Make an organ of it"), {.width = 220, .primary = true})) m_wanted_organ = m_segment;
  ImGui::End();
}

void ScanDesk::draw(const Area& middle, const Area& panel) {
  take_what_was_read();
  if (!m_scan) return;
  m_under.reset();
  const float w = std::floor(middle.width / 2), h = std::floor(middle.height / 2);
  for (int i = 0; i < 3; ++i)
    draw_slice(*m_panes[std::size_t(i)], {middle.x + (i == 1 ? w : 0), middle.y + (i == 2 ? h : 0), w, h}, i);
  draw_block({middle.x + w, middle.y + h, w, h});
  draw_panel(panel);
}

}  // namespace trocar::app

#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/modeller/scan/scan.hpp>
#include <trocar/scene/json/shape.hpp>

namespace trocar::modeller {

Scan Scan::open(const std::filesystem::path& path, const volumes::ReadOptions& options) {
  volumes::VolumeFile file = volumes::read_volume(path, options);
  Scan scan;
  scan.m_path = path;
  scan.m_volume = std::move(file.volume);
  scan.m_report = std::move(file.report);
  scan.m_labels = volumes::on_grid_of(scan.m_volume);
  return scan;
}

std::vector<std::string> Scan::take_labels(const std::filesystem::path& path, const volumes::ReadOptions& options) {
  volumes::LabelFile file = volumes::read_labels(path, options);
  std::vector<std::string> notes = file.report.notes;
  for (std::string& note : take_labels(std::move(file.labels))) notes.push_back(std::move(note));
  return notes;
}

std::vector<std::string> Scan::take_labels(volumes::Labels labels) {
  std::vector<std::string> notes;
  if (!(labels.grid == m_volume.grid)) {
    const std::vector<std::size_t> before = volumes::voxels_per_label(labels);
    labels = volumes::resampled(labels, m_volume.grid);
    const std::vector<std::size_t> after = volumes::voxels_per_label(labels);
    std::size_t lost = 0;
    for (std::size_t i = 1; i < before.size(); ++i) lost += before[i] > 0 && after[i] == 0;
    notes.push_back(
        "the labels are on another grid than the scan and were laid on its grid by their place in the patient");
    if (lost > 0) notes.push_back(tr("{} labels lie outside of the scan and are gone", lost));
  }
  volumes::name_all(labels);
  m_labels = std::move(labels);
  m_history.clear();
  m_done = 0;
  ++m_version;
  return notes;
}

std::uint16_t Scan::segment(const std::string& name) {
  for (const volumes::Segment& s : m_labels.segments)
    if (s.name == name) return s.label;
  std::uint16_t label = 1;
  for (const volumes::Segment& s : m_labels.segments)
    label = std::max<std::uint16_t>(label, std::uint16_t(s.label + 1));
  m_labels.segments.push_back({label, name, volumes::colour_of(label)});
  return label;
}

std::uint16_t Scan::segment_there(const std::string& name) const {
  std::vector<std::string> names;
  for (const volumes::Segment& s : m_labels.segments) {
    if (s.name == name || std::to_string(s.label) == name) return s.label;
    names.push_back(s.name);
  }
  const std::string message = names.empty()
                                  ? tr("There is no segment \"{}\". Create one first (Paint, Threshold or Grow).", name)
                                  : scene::unknown_name("segment", name, names);
  throw core::BadInput({{{m_path.generic_string(), 0, 0}, message}});
}

void Scan::rename(std::uint16_t label, const std::string& name) {
  for (volumes::Segment& s : m_labels.segments)
    if (s.label == label) s.name = name;
}

void Scan::change(const std::string& name, const volumes::LabelChange& change) {
  if (change.empty()) return;
  volumes::apply(m_labels, change);
  m_history.resize(m_done);
  m_history.push_back({name, change});
  ++m_done;
  ++m_version;
}

bool Scan::undo() {
  if (m_done == 0) return false;
  volumes::undo(m_labels, m_history[--m_done].change);
  ++m_version;
  return true;
}

bool Scan::redo() {
  if (m_done == m_history.size()) return false;
  volumes::apply(m_labels, m_history[m_done++].change);
  ++m_version;
  return true;
}

std::size_t Scan::history_bytes() const {
  std::size_t bytes = 0;
  for (const Entry& entry : m_history) bytes += entry.change.bytes();
  return bytes;
}

}  // namespace trocar::modeller

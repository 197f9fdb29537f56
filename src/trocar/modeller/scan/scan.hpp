// A patient's scan on the desk: its voxels, the labels that are drawn into them, and what was done to those, which can
// be undone without end at the cost of what was changed.
//
//   Scan scan = Scan::open("patient/series");
//   scan.change("liver", volumes::thresholded(scan.volume(), scan.labels(), {40, 180}, scan.label_named("liver")));
//   scan.undo();
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <trocar/volumes/files/volume_file.hpp>
#include <trocar/volumes/segment/label_change.hpp>

namespace trocar::modeller {

class Scan {
 public:
  /// @throws core::BadInput, core::EnvironmentLacks, volumes::Cancelled
  static Scan open(const std::filesystem::path& path, const volumes::ReadOptions& options = {});

  /// Labels from a file take the place of those that are there, on the scan's grid by place in the patient. Begins the
  /// history anew. Returns what is worth saying. @throws as open()
  std::vector<std::string> take_labels(const std::filesystem::path& path, const volumes::ReadOptions& options = {});

  /// The same from labels that are there.
  std::vector<std::string> take_labels(volumes::Labels labels);

  const volumes::Volume& volume() const { return m_volume; }
  const volumes::Labels& labels() const { return m_labels; }
  const volumes::ReadReport& report() const { return m_report; }
  const std::filesystem::path& path() const { return m_path; }

  /// The number of a segment; made where there is none of that name.
  std::uint16_t segment(const std::string& name);
  /// The number of one that is there; a whole number is one, too. @throws core::BadInput with what there is
  std::uint16_t segment_there(const std::string& name) const;

  void rename(std::uint16_t label, const std::string& name);

  void change(const std::string& name, const volumes::LabelChange& change);
  bool undo();
  bool redo();
  std::size_t done() const { return m_done; }
  std::size_t history_bytes() const;
  std::uint64_t version() const { return m_version; }  ///< another one after every change of labels

 private:
  struct Entry {
    std::string name;
    volumes::LabelChange change;
  };
  std::filesystem::path m_path;
  volumes::Volume m_volume;
  volumes::Labels m_labels;
  volumes::ReadReport m_report;
  std::vector<Entry> m_history;
  std::size_t m_done = 0;
  std::uint64_t m_version = 0;
};

}  // namespace trocar::modeller

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/vtk_data.hpp>

namespace trocar::geometry {

void VtkData::metadata() {  // up to an empty line
  m_values.in.skip_line();
  while (m_values.in.left() > 0 && !m_values.in.line().empty()) {
  }
}

void VtkData::begin(bool of_cells, std::size_t wanted, std::size_t at) {
  const std::int64_t count = m_values.whole(kVtkInt, "the number of values");
  if (count < 0 || std::uint64_t(count) != wanted)
    m_values.in.lose(at, tr("expected data of {} {}, got {}", wanted, of_cells ? "cells" : "points", count));
  m_values.in.skip_line();
  m_of_cells = of_cells;
  m_tuples = wanted;
}

void VtkData::attribute(const std::string& kind) {
  if (kind == "scalars") return scalars();
  const int components = kind == "vectors" || kind == "normals" ? 3 : kind == "tensors" ? 9 : 0;
  m_values.in.word();
  const VtkType* type = components > 0 ? m_values.find_type() : nullptr;
  if (!type) return stop(kind);
  m_values.pass(std::uint64_t(m_tuples) * std::uint64_t(components), *type);
}

void VtkData::scalars() {
  const std::string name = m_values.word();
  const VtkType* type = m_values.find_type();
  if (!type) return stop(name);
  const std::int64_t components = m_values.in.word_on_line() ? m_values.whole(kVtkInt, "the number of components") : 1;
  if (components < 1 || components > 4)
    m_values.in.lose(m_values.in.at(), tr("expected 1 to 4 components, got {}", components));
  m_values.in.skip_line();
  if (m_values.word() != "lookup_table")
    m_values.in.lose(m_values.in.at(), tr("expected LOOKUP_TABLE of the scalars {}, got none", in_quotes(name)));
  array(name, *type, std::uint64_t(components), m_tuples);
}

void VtkData::field() {
  m_values.in.word();
  const std::size_t arrays = m_values.in.count("arrays", 4);
  for (std::size_t i = 0; i < arrays; ++i) {
    if (m_values.next_word() == "metadata") {
      m_values.in.word();
      metadata();
    }
    const std::string name = m_values.word();
    const std::size_t components = m_values.in.count("components", 1), tuples = m_values.in.count("tuples", 1);
    m_values.in.skip_space();
    if (m_values.next_word() == "string") {
      m_values.in.word();
      const std::string first = m_values.strings(std::uint64_t(components) * std::uint64_t(tuples));
      if (name == "space") m_axes = patient_axes_named(first);
      continue;
    }
    const VtkType* type = m_values.find_type();
    if (!type) return stop(name);
    array(name, *type, components, tuples);
  }
}

void VtkData::array(const std::string& name, const VtkType& type, std::uint64_t components, std::size_t tuples) {
  const bool names_regions = name == "region" || name == "gmsh:physical" || name == "medit:ref";
  if (!names_regions || !m_of_cells || components != 1 || !type.whole || type.width == 0 || tuples != m_tuples)
    return m_values.pass(components * tuples, type);
  m_values.begin();
  m_regions.clear();
  for (std::size_t i = 0; i < tuples; ++i) {
    const std::size_t at = m_values.place();
    const std::int64_t region = m_values.whole(type, "a region");
    m_regions.push_back(int(region));
    if (region != m_regions.back()) m_values.in.fault(at, tr("expected a region of 32 bits, got {}", region));
  }
  m_values.end();
}

}  // namespace trocar::geometry

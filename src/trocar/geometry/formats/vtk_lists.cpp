#include <fmt/format.h>

#include <trocar/core/letters.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/formats/vtk_lists.hpp>

namespace trocar::geometry {

void VtkLists::read() {
  MeshSource& in = m_values.in;
  const bool text = !m_values.binary();
  const std::size_t first = in.count(m_things, text ? 2 : 1),
                    size = in.count(fmt::format("{}' nodes", m_things).c_str(), text ? 2 : 1);
  in.skip_line();
  const std::size_t values_at = in.at();
  if (m_values.next_word() == "offsets") return lengths_apart(first, size);
  in.go_to(values_at);  // in binary files blanks are values, too
  lengths_in_front(first, size);
}

void VtkLists::lengths_in_front(std::size_t count, std::size_t size) {
  MeshSource& in = m_values.in;
  in.set_form(m_values.form);
  const std::size_t least = in.binary() ? 4 : 2;
  if (size > in.left() / least || count > size)
    in.lose(in.at(), tr("expected {} {} in {} numbers, got {} bytes", count, m_things, size, in.left()));
  m_start.assign(1, 0);
  std::size_t left = size;
  for (std::size_t c = 0; c < count; ++c) {
    const std::size_t at = m_values.place();
    const std::int64_t nodes = m_values.whole(kVtkInt, "the number of a cell's nodes");
    if (left == 0 || nodes < 0 || std::uint64_t(nodes) > left - 1)
      in.lose(at, tr("expected a cell of at most {} nodes, got {}", left == 0 ? 0 : left - 1, nodes));
    left -= 1 + std::size_t(nodes);
    for (std::int64_t k = 0; k < nodes; ++k) point(kVtkInt);
    m_start.push_back(std::int64_t(m_points.size()));
  }
  if (left != 0)
    in.lose(m_values.place(),
            tr("expected {} numbers more in {}, got the end of the {}", left, core::in_capitals(m_things), m_things));
  m_values.end();
}

void VtkLists::lengths_apart(std::size_t offsets, std::size_t size) {
  MeshSource& in = m_values.in;
  in.word();
  const VtkType& type = m_values.index_type();
  m_values.begin();
  const std::size_t least = in.binary() ? std::size_t(type.width) : 2;
  if (offsets == 0 || offsets > (in.left() + 1) / least)
    in.lose(in.at(), tr("expected at least one offset and room for {}, got {} bytes", offsets, in.left()));
  for (std::size_t i = 0; i < offsets; ++i) {
    const std::size_t at = m_values.place();
    const std::int64_t offset = m_values.whole(type, "an offset"), before = i == 0 ? 0 : m_start.back();
    if (offset < before || std::uint64_t(offset) > size || (i == 0 && offset != 0))
      in.lose(at, tr("expected an offset from {} to {}, got {}", before, i == 0 ? 0 : size, offset));
    m_start.push_back(offset);
  }
  m_values.end();
  connectivity(size);
}

void VtkLists::connectivity(std::size_t size) {
  MeshSource& in = m_values.in;
  in.skip_space();
  const std::size_t at = in.at();
  if (m_values.word() != "connectivity") in.lose(at, tr("expected CONNECTIVITY, got {}", in.shown(at)));
  const VtkType& type = m_values.index_type();
  m_values.begin();
  const std::size_t least = in.binary() ? std::size_t(type.width) : 2;
  if (size > (in.left() + 1) / least || std::uint64_t(m_start.back()) != size)
    in.lose(in.at(), tr("expected {} nodes of {}, as OFFSETS says, got {} announced and {} bytes", m_start.back(),
                        m_things, size, in.left()));
  for (std::size_t i = 0; i < size; ++i) point(type);
  m_values.end();
}

void VtkLists::point(const VtkType& type) {
  m_at.push_back(static_cast<std::uint32_t>(m_values.place()));
  m_points.push_back(m_values.whole(type, "the number of a node"));
}

std::size_t VtkLists::place(std::size_t list, std::int64_t k) const {
  const std::int64_t item = m_start[list] + k;
  return item < std::int64_t(m_at.size()) ? m_at[std::size_t(item)] : m_values.in.all().size();
}

}  // namespace trocar::geometry

// The numbers by which fluids know bodies: surfaces (organs, then walls), sheets of folds, strands, one after the
// other. Only this says which number is whose.
#pragma once

#include <cstddef>

namespace trocar::interactions {

class WetOrder {
 public:
  constexpr WetOrder(std::size_t surfaces, std::size_t sheets) noexcept
      : m_sheets(int(surfaces)), m_strands(int(surfaces + sheets)) {}

  constexpr bool is_surface(int body) const noexcept { return body < m_sheets; }
  constexpr bool is_sheet(int body) const noexcept { return body >= m_sheets && body < m_strands; }
  constexpr bool is_strand(int body) const noexcept { return body >= m_strands; }
  /// Its number among its kind.
  constexpr std::size_t index(int body) const noexcept {
    return std::size_t(is_surface(body) ? body : body - (is_sheet(body) ? m_sheets : m_strands));
  }
  constexpr int sheet(std::size_t index) const noexcept { return m_sheets + int(index); }
  constexpr int strand(std::size_t index) const noexcept { return m_strands + int(index); }

 private:
  int m_sheets, m_strands;  // the first of each
};

}  // namespace trocar::interactions

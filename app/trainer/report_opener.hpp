// Makes the page of an attempt and opens it in the browser. The page is made by a second Trocar, `trocar report`: its
// pictures take seconds, and two renderers in one process are one too many for some drivers.
//
//   ReportOpener reports;
//   reports.open(store, uuid_or_number);
//   if (std::string page = reports.poll(); !page.empty()) ...      // once per picture: it is written, the browser has
//   it show(reports.say());
#pragma once

#include <string>

#include <sys/types.h>

#include <trocar/training/store/store.hpp>

namespace trocar::app {

class ReportOpener {
 public:
  /// Nothing happens while another page is being made, or without a store.
  /// @param names  the page says whose attempt it is
  void open(const training::Store* store, const std::string& attempt, bool names = false);
  std::string poll();                               ///< the page's path when it has just been finished, else empty
  const std::string& say() const { return m_say; }  ///< "Making the report ...", where it is, or why there is none

 private:
  pid_t m_child = 0;  ///< makes the page; it goes on by itself if the window closes
  std::string m_page, m_say;
};

}  // namespace trocar::app

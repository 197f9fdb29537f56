// The pages of the start screen, each in the room that is left between head and foot; see start_screen.hpp.
#pragma once

#include "start/start_screen.hpp"

namespace trocar::app {

void draw_person_page(const StartContent& content, StartMemory& memory, StartAnswer& answer);
void draw_exercises_page(const StartContent& content, StartMemory& memory);
void draw_details_page(const StartContent& content, StartMemory& memory, StartAnswer& answer);
void draw_recordings_page(const StartContent& content, StartMemory& memory, StartAnswer& answer);
void draw_rooms_page(StartMemory& memory, StartAnswer& answer);
void draw_instruments_page(StartMemory& memory, StartAnswer& answer);
void draw_box_page(const StartContent& content, StartMemory& memory, StartAnswer& answer);
void draw_team_page(const StartContent& content, StartMemory& memory, StartAnswer& answer);
void draw_more_page(const StartContent& content, StartMemory& memory, StartAnswer& answer);

/// News, notices, what went wrong: under the head of every page.
void draw_messages(const StartContent& content, StartAnswer& answer);
/// The last thing drawn takes the focus when the page has just been opened.
void first_focus(StartMemory& memory);
/// A file of a folder of scenes that can be shown in a window of its own.
struct ShownFile {
  std::string name, title;
};
/// Sorted by title. @param folder  under scenes
std::vector<ShownFile> files_of(const std::string& folder);
/// Their titles as buttons in columns; -1: none was pressed.
int draw_choices(const std::vector<ShownFile>& files, StartMemory& memory);

}  // namespace trocar::app

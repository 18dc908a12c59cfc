#include "support/deck_folder.h"

#include "support/command_line.h"

#include <filesystem>
#include <system_error>

namespace drumlin {

namespace fs = std::filesystem;

namespace {

bool has_blanks(const std::string &text) { return text.find_first_of(" \t\r\n\v\f") != std::string::npos; }

} // namespace

std::string folder_of_deck(const std::string &deck) {
  std::error_code code;
  fs::path file = deck;
  if (fs::is_symlink(file, code))
    if (const fs::path target = fs::canonical(file, code); !code) file = target;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!has_blanks(folder.string())) return folder.string();
  const fs::path from_here = fs::absolute(folder, code).lexically_proximate(fs::current_path(code));
  return has_blanks(from_here.string()) ? folder.string() : from_here.string();
}

void define_deck_folder(engine::LAMMPS *lmp) {
  const std::vector<std::string> words = command_line_arguments();
  std::string here = ".";
  for (std::size_t n = 1; n < words.size(); ++n)
    if (words[n - 1] == "-in" || words[n - 1] == "-i") here = folder_of_deck(words[n]);
  std::string name = "here";
  std::string style = "index";
  char *arguments[] = {name.data(), style.data(), here.data()};
  lmp->input->variable->set(3, arguments);
}

} // namespace drumlin

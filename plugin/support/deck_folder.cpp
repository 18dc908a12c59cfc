#include "support/deck_folder.h"

#include <filesystem>
#include <fstream>
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

void define_here(engine::LAMMPS *lmp) {
  std::ifstream file("/proc/self/cmdline");
  std::string here = ".";
  for (std::string word, previous; std::getline(file, word, '\0'); previous = word)
    if (previous == "-in" || previous == "-i") here = folder_of_deck(word);
  std::string name = "here";
  std::string style = "index";
  char *words[] = {name.data(), style.data(), here.data()};
  lmp->input->variable->set(3, words);
}

} // namespace drumlin

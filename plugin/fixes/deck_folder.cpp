#include "fixes/deck_folder.h"

#include <fstream>

namespace drumlin {

void define_here(engine::LAMMPS *lmp) {
  std::ifstream file("/proc/self/cmdline");
  std::string here = ".";
  for (std::string word, previous; std::getline(file, word, '\0'); previous = word)
    if (previous == "-in" || previous == "-i")
      here = word.find('/') == std::string::npos ? "." : word.substr(0, word.rfind('/'));
  std::string name = "here";
  std::string style = "index";
  char *words[] = {name.data(), style.data(), here.data()};
  lmp->input->variable->set(3, words);
}

} // namespace drumlin

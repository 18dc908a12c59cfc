#include "report/soil/element_tests.h"

#include "report/soil/pages.h"

namespace drumlin::post {

std::vector<ElementTest> element_tests() {
  return {{"oedometer", oedometer_title, read_oedometer_page},
          {"density", density_title, read_density_page},
          {"biaxial", biaxial_title, read_biaxial_page},
          {"triaxial", triaxial_title, read_triaxial_page},
          {"plate", plate_title, read_plate_page},
          {"loops", cyclic_shear_title, read_cyclic_shear_page}, // before shear, whose file it has, too
          {"shear", shear_title, read_shear_page},
          {"repose", repose_title, read_repose_page},
          {"silo", silo_title, read_silo_page},
          {"wall", wall_title, read_wall_page}};
}

} // namespace drumlin::post

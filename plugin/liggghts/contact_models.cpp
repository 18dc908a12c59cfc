// The contact models that the plugin adds to LIGGGHTS.

// These headers must come first: the engine's headers below use them without including them.
#include "fix_insert_stream.h"
#include "fix_mesh_surface.h"
#include "fix_property_atom.h"
#include "global_properties.h"

#include "contact_models.h"

#include "engine.h"
#include "liggghts/registration.h"
#include "liggghts/transition_model.h"
#include "physics/laws/laws.h"

void drumlin::add_contact_models() {
  // The engine's list of models is one for all instances in the process.
  const auto [number, name] = tangential_coulomb;
  auto &models = LIGGGHTS::ContactModels::Factory::instance();
  if (models.getTangentialModelId(name) == number) return;
  models.addTangentialModel(name, number);
  for_each_law([](auto law) { add_law<typename decltype(law)::type>(); });
}

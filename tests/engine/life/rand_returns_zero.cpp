// LIGGGHTS adds a joke or a tip to some errors, chosen by rand(). Preloaded after the plugin, this adds one
// to every error.
extern "C" __attribute__((visibility("default"))) int rand() { return 0; }

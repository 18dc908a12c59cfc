// Preloaded behind the plugin, this makes every error of LIGGGHTS one of those to which it adds a second line.
extern "C" __attribute__((visibility("default"))) int rand() { return 0; }

// The cohesion models that this plugin combines; the engine's own list is not part of its development
// package.

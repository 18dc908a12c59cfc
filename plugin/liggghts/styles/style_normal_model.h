// The normal models of the engine that this plugin uses: none, since its contact laws are no parts of the
// engine's combinations. The engine's own list is not part of its development package.

// The rolling models of the engine that this plugin uses: none; see style_normal_model.h.

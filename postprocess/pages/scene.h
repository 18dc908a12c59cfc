// Drawings of what a page is about: the model in one small picture, as inline SVG.
#pragma once

#include <string>

namespace drumlin::post {

/// The models of this project.
enum class Scene {
  chain, ///< fixed soil, drum and frame, joined by contact and suspension
  bed,   ///< drum and frame on a bed of balls
  held   ///< one ball confined between two walls
};

/// <figure class="scene"> with the drawing, its text alternative and a caption.
std::string scene_html(Scene scene);

} // namespace drumlin::post

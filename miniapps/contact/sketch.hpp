#pragma once

#include "common/scene.hpp"
#include "common/study.hpp"

#include <cattaneo/friction/contact_state.hpp>
#include <optional>
#include <vector>

namespace miniapp
{

/** The bodies of a march, deformed, for the page (--html): their vertices and elements, and at
    some increments the displacements of the vertices and von Mises' stress in the middle of
    each element. Of bodies with many elements only the boundary is drawn, of bodies in space
    the outer faces. There is no sketch on several ranks. */
class Sketch
{
public:
   /// The scene must outlive it.
   Sketch(Study &study, Scene &scene);
   /// To be called with every accepted increment, as the film of the march is.
   void note(const cattaneo::ContactState &reached);
   /// Recovers the fields at the increments that were kept, one solve per body.
   void report();

private:
   nlohmann::ordered_json frame(const cattaneo::ContactState &state, std::size_t row);
   /// The vertices of a body that are drawn, and the element of each cell that is filled: of
   /// each element, in space of each outer face.
   struct Drawn
   {
      std::vector<int> vertices, elements;
   };
   nlohmann::ordered_json body(std::size_t k);
   Study &study_;
   Scene &scene_;
   std::vector<Drawn> drawn_; ///< of each body
   bool wanted_ = false, filled_ = false;
   struct Kept
   {
      std::size_t row;
      cattaneo::ContactState state;
   };
   std::vector<Kept> kept_;
   std::optional<Kept> last_;
   std::size_t rows_ = 0, stride_ = 1;
};

} // namespace miniapp

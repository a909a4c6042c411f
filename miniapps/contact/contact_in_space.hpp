#pragma once

#include "contact/own_bodies.hpp"
#include "contact/rims.hpp"

namespace miniapp
{

class OwnHistory;

/// The reduction of a case of bodies in space.
struct BodiesInSpace
{
   Scene scene;
   std::vector<std::vector<cattaneo::Material>> materials; ///< of each body
   std::vector<std::vector<double>> densities;             ///< likewise; empty: not given
   double accuracy = 0; ///< estimated relative error of the stiffness, the worst
   std::vector<std::vector<Holding>> holdings;  ///< of each body
   std::optional<cattaneo::BoltedJoint> bolted; ///< for bolts that are tightened to a force
   std::vector<NodeAtCorner> corners;           ///< contact nodes with more than one normal
};

/// InputError naming body and key. The case must outlive them.
BodiesInSpace make_bodies_in_space(const JointCase &joint);

/** Marches a case of bodies in space and reports it. `history` has its options, `paraview` is a
    folder or empty. InputError as of the parts. */
void contact_in_space(Study &study, const JointCase &joint, OwnHistory &history,
                      const std::string &paraview);

} // namespace miniapp

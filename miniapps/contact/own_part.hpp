#pragma once

#include "contact/own_bodies.hpp"

#include <cattaneo/elastic/statements.hpp>
#include <cattaneo/exchange/nodal_stiffness.hpp>
#include <cattaneo/input_error.hpp>
#include <cattaneo/mesh/mesh_file.hpp>
#include <cattaneo/mesh/smooth_sides.hpp>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace miniapp
{

/// A body of a case before it is condensed: elements, or nodes of a matrix.
class OwnPart
{
public:
   OwnPart(OwnBodies &own, const JointCase &joint, int b);
   /// Makes the body of a matrix that comes with the node sets of the body's contacts.
   void make_of_matrix(cattaneo::NodalStiffness matrix);
   /// The torsion body on the same mesh.
   void add_twisting(OwnBodies &own, std::size_t b);

   cattaneo::ContactLine line(const JointCase::Side &side) const;
   bool has_load(const std::string &load) const;
   /// The middle of an end of a shank.
   Eigen::Vector2d middle(const JointCase::Side &end) const;
   /// Adds forces on an end of a shank that add up to F, spread evenly.
   void pull(const std::string &load, const JointCase::Side &end, const Eigen::Vector2d &F);
   /// Does a load act only on dofs that supports and other loads hold?
   bool holds_all_of(const std::string &load) const;
   /// InputError if two loads, or a load and a support, ask for different displacements of a
   /// node.
   void require_one_displacement() const;
   cattaneo::CondensedBody condensed(const cattaneo::ContactLine &line,
                                     const cattaneo::CondensedBody *alike) const;
   const cattaneo::SmoothSides &sides() const { return sides_; }
   /// To be called when all loads exist, those of shanks too.
   HeldBody held() const;
   /// Likewise: a matrix with its mass; none of other bodies.
   std::optional<cattaneo::VibratingBody> vibrating() const;
   /// Does the case have supports or loads around the axis?
   bool twists() const { return cattaneo::twists(body_.support, body_.load); }
   /// Condenses to the nodes of the body's sides of interfaces, in their order.
   cattaneo::CondensedBody condensed_twisting(const std::vector<JointCase::Side> &sides) const;

   /// The diagonal of the box around it; 0: not known, on several ranks.
   double size() const;
   /// Are its vertices at the places of the other body's? False for matrices.
   bool lies_on(const OwnPart &other) const;
   /// Dofs that its supports hold.
   std::set<int> supported() const;

   /// In a sentence.
   std::string called() const;
   template <class Action>
   auto named(Action action) const
   {
      try
      {
         return action();
      }
      catch (const cattaneo::InputError &error)
      {
         throw cattaneo::InputError(called() + ": " + error.what());
      }
   }

private:
   void make_of_mesh(OwnBodies &own, int b);
   std::vector<int> fixed() const;
   /// Place of a dof, its component in words, and whether it turns about the axis.
   struct Dof
   {
      Eigen::Vector2d place{0, 0};
      int component = 0;
   };
   std::vector<Dof> dofs_of(const cattaneo::ElasticBody &body) const;
   std::vector<Dof> dofs() const;
   /// Does something that holds dofs. The dofs that were free before are recorded as held by
   /// it.
   template <class Hold>
   void hold(const std::string &kind, const std::string &name, Hold hold);
   /// The same around the axis.
   template <class Hold>
   void hold_around(const std::string &kind, const std::string &name, Hold hold);
   /// Boundary attributes of the body's sides of interfaces; of slits: those on which it meets
   /// itself.
   std::vector<int> of_sides(int b, bool slits = false) const;
   int order() const { return body_.order > 0 ? body_.order : joint_.order; }

   const JointCase &joint_;
   const JointCase::Body &body_;
   cattaneo::ElasticBody *elastic_ = nullptr, *twisting_ = nullptr;
   std::vector<double> vertices_; ///< x and y of each vertex of its mesh
   std::optional<cattaneo::NodalStiffness> nodal_;
   cattaneo::BodyTerms terms_;
   cattaneo::SmoothSides sides_;            ///< what curve_sides() did to the mesh
   std::vector<Holding> holdings_, around_; ///< the second around the axis
   /// Rows of a matrix that a load prescribes.
   std::map<std::string, std::set<int>> prescribed_;
};

/// The materials of a body's attributes, from its elastic constants. InputError naming the key.
std::vector<cattaneo::Material> materials_of(JointCase::Body body, const mfem::Mesh &mesh,
                                             const cattaneo::MeshNames &names,
                                             bool plane_stress);
/// The densities of a body's attributes: none, one for all, or one for each. InputError naming
/// the key.
std::vector<double> densities_of(JointCase::Body body, const mfem::Mesh &mesh,
                                 const cattaneo::MeshNames &names);

/// The displacements that a load prescribes to dofs of a body.
struct Prescribed
{
   std::string load;
   std::set<int> dofs;
   const Eigen::VectorXd *values;
};
/// InputError if two loads, or a load and a support, ask for different displacements of a node.
/// `component`, `where`: of a dof its number, 0 to 2, and its place and direction in words.
void require_one_displacement(const std::vector<Prescribed> &all,
                              const std::vector<Holding> &holdings,
                              const std::function<int(int dof)> &component,
                              const std::function<std::string(int dof)> &where);

/// Gives each body that is a matrix the part of its file with the sets that its interfaces
/// name.
void find_matrices(OwnBodies &own, const JointCase &joint, std::vector<OwnPart> &parts);

/// Adds torsion bodies for all bodies if a support or a load of one body acts around the axis.
bool twist(OwnBodies &own, const JointCase &joint, std::vector<OwnPart> &parts);
std::vector<cattaneo::CondensedBody> condensed_twisting(const JointCase &joint,
                                                        const std::vector<OwnPart> &parts);

} // namespace miniapp

#pragma once

#include <cattaneo/halfplane/half_plane.hpp>
#include <memory>
#include <mfem.hpp>
#include <string>
#include <vector>

namespace cattaneo
{

/// Writes one more time of a series. InputError if the folder cannot be made or written.
void save(mfem::ParaViewDataCollection &series, const std::string &folder, double time);
/// InputError if it cannot be made.
void make_folder(const std::string &folder);

/** Series of the fields below the surface of a half-plane for ParaView, as BodyFields writes
    them of a meshed body, on a mesh that is made for it alone: a window below the contact line,
    one and a half of its lengths deep and wide beyond its ends. Values at its nodes are those
    of HalfPlaneField; displacements are relative to the half-plane's depth.

    Nothing is computed or written before write(). */
class HalfPlaneFields
{
public:
   /// @a line: of the condensed half-plane. InputError unless it is of the plane.
   HalfPlaneFields(const HalfPlane &body, const ContactLine &line, const std::string &directory,
                   const std::string &name);

   /// Writes one more time of the series. @a forces: on the nodes of the line, as for
   /// HalfPlaneField. @a loads: multipliers, from which bulk stresses follow. InputError if the
   /// folder cannot be written.
   void write(const Eigen::VectorXd &forces, double time, const NamedLoads &loads = {});

   /// A field as last written; InputError if there is none of that name.
   const mfem::GridFunction &field(const std::string &name) const;

private:
   HalfPlane body_;
   ContactLine line_;
   std::string directory_;
   mfem::Mesh mesh_;
   mfem::H1_FECollection nodal_{1, 2};
   mfem::L2_FECollection broken_{1, 2, mfem::BasisType::GaussLobatto};
   mfem::FiniteElementSpace displacements_, stresses_;
   std::vector<std::unique_ptr<mfem::GridFunction>> fields_; ///< by the names of series_
   mfem::ParaViewDataCollection series_;
};

} // namespace cattaneo

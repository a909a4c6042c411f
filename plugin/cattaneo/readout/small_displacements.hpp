#pragma once

#include <cattaneo/reduced/reduction.hpp>
#include <string>
#include <vector>

namespace cattaneo
{

struct ContactState;

/** Checks whether displacements of a march were small. The theory assumes that nodes keep
    facing the same place, and that gaps are measured along the initial normals. With large
    displacements results are wrong, and nothing in them shows it. */
class SmallDisplacements
{
public:
   /// `even` says for each interface whether its obstacle is the same wherever a node slides,
   /// as a straight rigid line is. Slip is not limited there. The reduction must outlive this.
   explicit SmallDisplacements(const Reduction &reduction, std::vector<bool> even = {});

   /// A state that the march has reached.
   void note(const ContactState &state);

   /// A sentence for each interface and limit that was passed: the slip of a node in contact is
   /// larger than its distance from the next node, or a gap of more than a tenth of the
   /// interface's length has closed.
   std::vector<std::string> warnings() const;

private:
   struct Most
   {
      Eigen::Index node = -1;
      double value = 0, share = 0;
   };
   const Reduction &reduction_;
   std::vector<bool> even_;
   std::vector<Most> slip_, gap_; ///< of each interface
};

/// A sentence if a body turns by more than a twentieth (3 degrees) anywhere, else nothing. The
/// third coordinate of the place is told in space alone.
std::string rotation_warning(const std::string &body, double rotation,
                             const Eigen::Vector3d &place, bool in_space = false);

} // namespace cattaneo

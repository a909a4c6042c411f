#pragma once

#include <cattaneo/exchange/nodal_stiffness.hpp>

namespace cattaneo
{

/** Reads a stiffness that another program wrote. `places` names the file with the places of its
    nodes, if that is not beside it with the same name. The end of the name and the first line
    decide how the file is read:

    - `.sti`, places in `.inp`: CalculiX, *FREQUENCY, SOLVER=MATRIXSTORAGE; rows from `.dof`
    - `.mtx`, places in `.inp`, of the same name or of that before "_STIF1", as ABAQUS names
      its matrices: ABAQUS, *MATRIX GENERATE, with FORMAT=MATRIX INPUT or COORDINATE (rows are
      then both directions of each node that has an element, by the numbers of nodes), or
      (dense) *USER ELEMENT, *MATRIX, TYPE=STIFFNESS, which CalculiX writes too
    - `.mtx`, places in `.dofs`: MatrixMarket, coordinate or array
    - `.npy`, places in `.dofs`: NumPy, a dense matrix
    - `.npz`, places in `.dofs`: scipy.sparse.save_npz(…, compressed=False), or an array K;
      without a `.dofs` if it has the arrays that write_npz() writes

    An `.inp` gives nodes, elements (so that contact lines follow outer edges), sets, and the
    loads of its steps: each *CLOAD card is a load of forces, "CLOAD1", …, each *BOUNDARY card
    with displacements a load "BOUNDARY1", …; zero ones are supports. With elements SPRING1 or
    SPRING2 a body without supports need not be free. Without plane elements a comment **
    AXISYMMETRIC says that x is r. Supports that CalculiX took out of the matrix, all of those
    of its step, have no row here either. Rows with 1e36 on the diagonal, supports of ABAQUS,
    are fixed, and uncoupled from the others: they may be on contact nodes, and cannot be moved.
    Internal nodes of ABAQUS (negative numbers) are eliminated. Of CalculiX's axisymmetric
    elements, flat wedges of 2 degrees, the matrix is multiplied by 180: 2e-4 of it are the
    wedge's.

    A `.dofs` file has a line `node direction x y` for each row, in their order. It may also
    have lines `axisymmetric`, `set NAME nodes…`, `fixed node direction`, `force LOAD node
    direction value` and `displacement LOAD node direction value`; # begins a comment.

    InputError, in one sentence with the file and the line or the entry, if the file is cut
    short, or contains numbers that are not finite, entries that are there twice or not
    symmetric, rotations, or a third direction of a plane body. */
NodalStiffness read_stiffness(const std::string &matrix, const std::string &places = "");

/** Reads the mass of a stiffness from a file into NodalStiffness::M. The end of the name and
   the first line decide how the file is read, as read_stiffness() has it:

    - `.mas`, of CalculiX' SOLVER=MATRIXSTORAGE, rows from `.dof`, deck in `.inp`
    - `.mtx`, deck in `.inp`, of the same name or of that before "_MASS1": ABAQUS,
      *MATRIX GENERATE, MASS
    - `.mtx` of MatrixMarket, `.npy`, `.npz`: rows in the order of those of the stiffness

    Units are those of the file. To be called before parts(), which takes the mass apart as
   well. InputError as of read_stiffness(), if the file has a node and direction without a row
   in the stiffness, if a row that is not fixed has a stiffness and no mass, if internal nodes
   have a mass, or if the number of rows is another one.
   @param deck  with the nodes; without it that beside the mass with its name, or else that
                beside the stiffness */
void read_mass(NodalStiffness &stiffness, const std::string &file,
               const std::string &deck = "");

/// The file of the stiffness that a deck "job.inp" writes: "job.sti" of CalculiX, "job.mtx", or
/// "job_STIF1.mtx" of ABAQUS, beside it. InputError if there is none, or more than one.
std::string matrix_of_deck(const std::string &deck);

} // namespace cattaneo

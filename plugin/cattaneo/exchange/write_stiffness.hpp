#pragma once

#include <cattaneo/exchange/nodal_stiffness.hpp>
#include <cattaneo/reduced/reduced_problem.hpp>

namespace cattaneo
{

/// Arrays by name: an .npz file that np.load reads, not compressed. InputError if it cannot be
/// written.
void write_npz(const std::string &file, const std::map<std::string, Eigen::MatrixXd> &arrays);

/** For programs of joint dynamics, as arrays: `K` (all entries), `loads` (one column per load),
    `dofs` (node and direction of each row), `places` (of the node of each row, two coordinates
    or three), `fixed` (rows, from 0) and, if a mass matrix is given, `M` with the same rows.
    Other arrays are for read_stiffness(): `load NAME` (the number of its column), `set NAME`
    (its nodes), `faces` (one row per face, filled up with -1), and `axisymmetric` and
    `supports_left_out` if they are true. All of it but M comes back to the last bit, as of
    write_matrix_market(). InputError if M does not fit, or loads prescribe displacements. */
void write_npz(const std::string &file, const NodalStiffness &stiffness,
               const Eigen::MatrixXd &M = {});

/** A reduced problem {q;p} = K {v;w} + Σ ℓ_k f_k: `K`, `loads` (the columns f_k), `H`, `gap`,
    `friction`, `weights`, `position` and, if it is given, `M` with the same rows. */
void write_npz(const std::string &file, const ReducedProblem &problem,
               const Eigen::MatrixXd &M = {});

/// MatrixMarket, coordinate, symmetric, and beside it the `.dofs` that read_stiffness() needs.
/// All of it is read back to the last bit, except that sets lose nodes without rows. `file`
/// ends with `.mtx`.
void write_matrix_market(const std::string &file, const NodalStiffness &stiffness);

/** ABAQUS: a linear user element of all nodes (*USER ELEMENT, *MATRIX, TYPE=STIFFNESS, the
    lower triangle by rows), and beside it, `.inp` for `.mtx`, a deck with its nodes, sets,
    element, supports and one *CLOAD card a load of forces; the comment ** AXISYMMETRIC marks a
    body of revolution. Nodes that are counted from 0 are counted from 1 there. InputError if
    loads prescribe displacements. */
void write_abaqus(const std::string &file, const NodalStiffness &stiffness);

/** Nastran: a bulk data file with the matrix as DMIG `KAAX` (symmetric, double precision, with
    0 where K has no entry), its nodes as GRID (x, y, 0), supports as SPC1 of set 1, and a load
    of forces each as FORCE of a set of its own, 1, 2, …, named by comments. Nodes that are
    counted from 0 are counted from 1 there. Fields of 16 columns have 10 or 11 digits: the
    relative error of entries, and of the balance of rigid motions, is 5e-10. Of a body of
    revolution entries are of the whole circumference. InputError if loads prescribe
    displacements. */
void write_nastran(const std::string &file, const NodalStiffness &stiffness);

} // namespace cattaneo

#pragma once

#include <cattaneo/exchange/nodal_stiffness.hpp>
#include <cattaneo/reduced/reduced_problem.hpp>

namespace cattaneo
{

/// Arrays by name: an .npz file that np.load reads, not compressed. InputError if it cannot be
/// written.
void write_npz(const std::string &file, const std::map<std::string, Eigen::MatrixXd> &arrays);

/** For programs of joint dynamics, as arrays: `K`, `loads` (a column a load), `dofs` (a row
   each: node, direction), `places` (of each row's node), `fixed` (rows, from 0), `M` if a mass
   matrix is given, of the same rows. InputError if M does not fit, or loads prescribe
   displacements. */
void write_npz(const std::string &file, const NodalStiffness &stiffness,
               const Eigen::MatrixXd &M = {});

/** A reduced problem {q;p} = K {v;w} + Σ λ_k f_k: `K`, `loads` (a column f_k each), `H`, `gap`,
    `friction`, `weights`, `position`, and `M` if it is given, of the same rows. */
void write_npz(const std::string &file, const ReducedProblem &problem,
               const Eigen::MatrixXd &M = {});

/// MatrixMarket, coordinate, symmetric, beside it the `.dofs` that read_stiffness() asks for:
/// all of it comes back to the last bit, but for nodes without rows, which leave their sets.
/// `file` ends with `.mtx`.
void write_matrix_market(const std::string &file, const NodalStiffness &stiffness);

/** ABAQUS: a linear user element of all nodes (*USER ELEMENT, *MATRIX, TYPE=STIFFNESS, the
   lower triangle by rows), and beside it, `.inp` for `.mtx`, a deck with its nodes, sets,
   element, supports and one *CLOAD card a load of forces; a comment, ** AXISYMMETRIC, says of
    a body of revolution that it is one. InputError if loads prescribe displacements. */
void write_abaqus(const std::string &file, const NodalStiffness &stiffness);

} // namespace cattaneo

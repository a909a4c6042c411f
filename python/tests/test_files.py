"""What other programs' Python libraries write and read."""

import os
import subprocess
import sys

import cattaneo
import numpy as np
import pytest
from scipy import io, sparse
from test_bodies import strip


def same(read, body):
    """But for its name."""
    assert abs(read.K - body.K).max() == 0
    assert np.array_equal(read.dofs, body.dofs)
    assert np.array_equal(read.places, body.places)
    assert list(read.fixed) == list(body.fixed)
    assert list(read.loads) == list(body.loads)
    for name, load in body.loads.items():
        assert np.array_equal(read.loads[name], load)


def test_what_write_npz_wrote_is_read_without_anything_beside_it(tmp_path):
    body = strip(4)
    body.fix([0, 1], "x")
    body.add_forces("P", [5], "y", -1.5)
    file = tmp_path / "body.npz"
    cattaneo.write_npz(file, body)
    same(cattaneo.read_stiffness(file), body)
    # NumPy's compressed form of the same arrays.
    with np.load(file) as arrays:
        np.savez_compressed(tmp_path / "pressed.npz", **dict(arrays))
    read = cattaneo.read_stiffness(tmp_path / "pressed.npz")
    same(read, body)
    assert read.name == str(tmp_path / "pressed.npz")


def test_sparse_matrices_of_scipy_and_matlab_with_dofs_beside_them(tmp_path):
    body = strip(4)
    cattaneo.write_matrix_market(tmp_path / "K.mtx", body)  # and K.dofs
    sparse.save_npz(tmp_path / "K.npz", body.K)  # compressed, its default
    same(cattaneo.read_stiffness(tmp_path / "K.npz"), body)
    for K in (body.K, body.K.toarray()):
        for pressed in (False, True):
            io.savemat(tmp_path / "K.mat", {"K": K}, do_compression=pressed)
            same(cattaneo.read_stiffness(tmp_path / "K.mat"), body)
            same(cattaneo.read_stiffness(tmp_path / "K.mat", tmp_path / "K.dofs"), body)
    io.savemat(tmp_path / "K.mat", {"stiffness": body.K})
    with pytest.raises(cattaneo.InputError, match="K.mat' has no matrix K, there is stiffness"):
        cattaneo.read_stiffness(tmp_path / "K.mat")
    (tmp_path / "K.mat").write_bytes(b"MATLAB 7.3 MAT-file" + bytes(200))
    with pytest.raises(cattaneo.InputError, match="K.mat' is not a .mat file of version 4 to 7.2"):
        cattaneo.read_stiffness(tmp_path / "K.mat")
    with pytest.raises(cattaneo.InputError, match="missing.mat' cannot be read"):
        cattaneo.read_stiffness(tmp_path / "missing.mat")
    pressed = (tmp_path / "K.npz").read_bytes()
    (tmp_path / "cut.npz").write_bytes(pressed[:60] + bytes(20) + pressed[80:])
    with pytest.raises(cattaneo.InputError, match="cut.npz' is damaged"):
        cattaneo.read_stiffness(tmp_path / "cut.npz")


READ_BACK = """
import sys
import numpy
from pyNastran.bdf.bdf import read_bdf
model = read_bdf(sys.argv[1], xref=False, punch=True, debug=None)
matrix, rows, columns = model.dmig["KAAX"].get_matrix(is_sparse=False)
order = [rows[k] for k in range(len(rows))]
numpy.savez(sys.argv[2], K=matrix, dofs=order, places=[model.nodes[n].xyz for n, _ in order],
            held=[[s.nodes[0], int(s.components)] for s in model.spcs[1]],
            force=[[f.node, f.mag * f.xyz[0], f.mag * f.xyz[1]] for f in model.loads[1]])
"""


def test_pynastran_reads_what_write_nastran_wrote(tmp_path):
    folder = os.environ.get("CATTANEO_PYNASTRAN", "")
    with_it = dict(os.environ, PYTHONPATH=folder)
    if subprocess.run([sys.executable, "-c", "import pyNastran.bdf.bdf"], env=with_it, capture_output=True).returncode:
        pytest.skip("pyNastran is not there (CATTANEO_PYNASTRAN names its folder)")
    body = strip(4)
    body.fix([0, 1], "x")
    body.add_forces("P", [5], "y", -1.5)
    cattaneo.write_nastran(tmp_path / "body.bdf", body)
    subprocess.run([sys.executable, "-c", READ_BACK, tmp_path / "body.bdf", tmp_path / "back.npz"], env=with_it, check=True)
    back = np.load(tmp_path / "back.npz")
    # Nastran's nodes are counted from 1.
    known = {(node + 1, k + 1): row for node, rows in enumerate(body.dofs.tolist()) for k, row in enumerate(rows)}
    order = [known[tuple(dof)] for dof in back["dofs"].tolist()]
    assert sorted(order) == list(range(len(known)))
    K = body.K.toarray()[np.ix_(order, order)]
    # A field of 16 columns has ten digits at least.
    assert np.all(np.abs(back["K"] - K) <= 0.5e-9 * 1.0001 * np.abs(K))
    places = {n: p for (n, _), p in zip(back["dofs"].tolist(), back["places"])}
    for node, place in places.items():
        assert np.allclose(place[:2], body.places[node - 1], rtol=1e-9, atol=0) and place[2] == 0
    assert [known[tuple(dof)] for dof in back["held"].tolist()] == list(body.fixed)
    assert back["force"].tolist() == [[6, 0, -1.5]]


def test_a_mass_matrix_may_be_sparse(tmp_path):
    body = strip(4)
    M = sparse.diags_array(np.arange(1.0, body.K.shape[0] + 1))
    for each in (M, M.tocsr(), M.toarray()):
        cattaneo.write_npz(tmp_path / "body.npz", body, each)
        assert np.array_equal(np.load(tmp_path / "body.npz")["M"], M.toarray())


def test_digits_that_float32_has_not(tmp_path):
    body = strip(9)
    for K in (body.K.astype(np.float32), body.K.toarray().astype(np.float32)):
        with pytest.raises(cattaneo.InputError, match=r"K is float32, of 7 digits: assemble it in float64"):
            cattaneo.NodalStiffness(K, body.places)

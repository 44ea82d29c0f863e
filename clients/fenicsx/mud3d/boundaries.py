# SPDX-License-Identifier: MIT
"""Loads on the boundary, and boundaries that let waves out: docs/theory/host.md sections 7.2 and 7.4."""
import numpy as np

from .balances import between
from .scene import SceneError
from .space import NUMBERS, PRESSURE


def loads(run, stage, time):
    """Nodal loads at a time, as a local vector."""
    total = np.zeros(run.space.size)
    for load in run.scene.loads:
        if run.scene.acts(load, stage):
            total += run.scene.factor(load.history, time)*_unit(run, load)
    return total


def _unit(run, load):
    """Nodal loads of a load whose history is 1, kept."""
    if "unit" not in load:
        load["unit"] = _integrated(run, load)
    return load["unit"]


def _integrated(run, load):
    space, local = run.space, np.zeros(run.space.size)
    axis = {"r": 0, "y": 1, "z": run.up}.get(load.kind[-1])
    plate = next((p for p in run.scene.plates if p.name == load.group), None)
    if load.kind.startswith("force"):
        if plate is None and run.share != 1.0:
            raise SceneError(f"&load kind = '{load.kind}': forces on the nodes of another mesh are not carried")
        if plate is not None:
            run._at(plate["master"], local, load.value*run.share)
            return local
        nodes = space.nodes_of(load.group, 2)
        local[space.of_u[nodes, axis]] = load.value + load.value_slope*(space.places_u[nodes, run.up] - load.datum)
        return local
    if load.group not in space.facet_groups:
        raise SceneError(f"&load group = '{load.group}': there is no such boundary")
    cells, shape_u, shape_p, normal, places = space.on_facets(load.group)
    amount = load.value + load.value_slope*(places[..., run.up] - load.datum)
    if load.kind == "water":
        if not space.pressure_degree:
            raise SceneError("&load kind = 'water' in a scene without p_w")
        q = np.einsum("fqm,fq,fq->fm", shape_p, amount, np.linalg.norm(normal, axis=-1))
        return space.gathered(q, space.of_p[space.nodes_p[cells]])
    if load.kind == "pressure":
        traction = -amount[..., None]*normal
    else:
        traction = np.zeros_like(normal)
        area = np.linalg.norm(normal, axis=-1)*amount
        if run.swept and axis == 0:
            traction[..., :2] = area[..., None]*places[..., :2]/np.linalg.norm(places[..., :2], axis=-1)[..., None]
        else:
            traction[..., axis] = area
    f = np.einsum("fqn,fqi->fni", shape_u, traction)
    shape = (len(cells), f.shape[1]*f.shape[2])
    return space.gathered(f.reshape(shape), space.of_u[space.nodes_u[cells]].reshape(shape))


def absorbing(run, stage):
    """Dashpots of a stage: (unknowns of facets, matrices against rates), and the waves that come in."""
    space, points, found = run.space, run.points, []
    run.waves = []
    for entry in run.scene.absorbings:
        if not run.scene.acts(entry, stage):
            continue
        if entry.group not in space.facet_groups:
            raise SceneError(f"&absorbing group = '{entry.group}': there is no such boundary")
        cells, shape_u, shape_p, normal, _ = space.on_facets(entry.group)
        area = np.linalg.norm(normal, axis=-1)
        n = normal/area[..., None]
        rho, c_p, c_s, lets = (x[cells][:, None] for x in _ground_behind(run, entry, n, cells))
        nn = n[..., :, None]*n[..., None, :]
        eye = np.eye(space.dimension)
        strength = (rho*area)[..., None, None]*(c_p[..., None, None]*nn + c_s[..., None, None]*(eye - nn))
        block = np.einsum("fqa,fqij,fqb->faibj", shape_u, strength, shape_u)
        size = block.shape[1]*block.shape[2]
        block = block.reshape(len(cells), size, size)
        dofs = space.of_u[space.nodes_u[cells]].reshape(len(cells), size)
        found.append((dofs, block))
        if entry.v_r or entry.v_z:
            wave = np.zeros((space.dimension,))
            wave[0], wave[run.up] = entry.v_r, entry.v_z
            into = np.einsum("cij,cj->ci", block, np.tile(wave, (len(cells), size//space.dimension)))
            run.waves.append((entry, space.gathered(2.0*into, dofs)))
        if space.pressure_degree:
            drain = np.einsum("fqa,fq,fqb->fab", shape_p, area*lets/c_p, shape_p)
            found.append((space.of_p[space.nodes_p[cells]], drain))
    return found


def incoming(run, scheme, time_0, time_1):
    """Traction of the waves that come in, at the level of velocities."""
    total = 0.0
    for entry, unit in getattr(run, "waves", ()):
        total = total + unit*between(*(run.scene.factor(entry.history, t) for t in (time_0, time_1)), scheme.l_v)
    return total


def _ground_behind(run, entry, normal, chosen):
    """Density, speeds of waves and conductivity of every cell in its present state, or what the keys say."""
    space, points, ground = run.space, run.points, run.ground
    shape = (space.cells, space.per_cell)
    p = space.numbers(run.x)[0].reshape(-1, NUMBERS)[:, PRESSURE]
    suction, turn = ground.suction(p)
    points.update(np.zeros((points.n, 6)), suction)  # the elastic slopes
    n, s = points.e0/(1.0 + points.e0), points.s0
    rho = ground.density(n, s).reshape(shape).mean(1)
    D = points.tangent.reshape(*shape, 6, 6).mean(1)
    direction = np.zeros((space.cells, 3))
    direction[chosen, :space.dimension] = normal[:, 0]
    a, b, c = direction.T
    strain = np.stack([a*a, b*b, c*c, 2*a*b, 2*a*c, 2*b*c], 1)
    unit = np.stack([a*a, b*b, c*c, a*b, a*c, b*c], 1)
    # traction along the normal of a strain n n: n . (D : n n) . n
    pressure = np.einsum("ci,cij,cj->c", strain, D, unit)
    shear = (D[:, 3, 3] + D[:, 4, 4] + D[:, 5, 5])/3.0
    lets = np.zeros(space.cells)
    if ground.wet:
        storage = n*s/ground.k_w + n*points.ds_dpc*turn
        pressure = pressure + (s*s/storage).reshape(shape).mean(1)
        lets = ground.conductivity(s)[0].reshape(shape).mean(1)
    rho = np.full_like(rho, entry.rho) if entry.rho is not None else rho
    c_p = np.full_like(rho, entry.c_p) if entry.c_p is not None else np.sqrt(np.maximum(pressure, 0.0)/rho)
    c_s = np.full_like(rho, entry.c_s) if entry.c_s is not None else np.sqrt(shear/rho)
    c_p[c_p == 0.0] = 1.0  # cells that do not touch the boundary
    return rho, c_p, c_s, lets


def hold_ground(run):
    """The traction that an absorbing boundary carries when its stage begins: what the state there lacks to balance."""
    run.traction0 = np.zeros(run.space.size)
    free = np.zeros(run.space.size, bool)
    for dofs, _ in run.dashpots:
        free[dofs.ravel()] = True
    free &= run.space.is_u
    free = (run.space.summed(free.astype(float)) > 0) & ~run.constraints.fixed
    saved, run.dashpots = run.dashpots, []
    residual = run._static_residual()
    run.dashpots = saved
    run.traction0 = np.where(free, residual, 0.0)


def held(run):
    return run.traction0

"""Fields of three-axis force."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._error import ArgumentError, Error, FrameError, MissingError
from ._frames import Path, range_of, warn
from ._lerobot import Columns, Features, columns_and_features
from ._picture import picture
from ._status import REGIONS, Status

if TYPE_CHECKING:
    import pandas
    import xarray

Floats = npt.NDArray[np.float32]
Bytes = npt.NDArray[np.uint8]
Doubles = npt.NDArray[np.float64]

_FORCES = ("shear_x", "shear_y", "normal")
_ANGLES = ("magnitude", "theta", "phi")


def _short(planes: Any) -> str:
    """Names and shapes of the arrays of a dataclass."""
    given = {field.name: getattr(planes, field.name) for field in dataclasses.fields(planes)}
    arrays = {name: plane for name, plane in given.items() if plane is not None}
    shape = " x ".join(map(str, next(iter(arrays.values())).shape))
    return f"<{type(planes).__name__}: {', '.join(arrays)}, {shape}>"


@dataclasses.dataclass(frozen=True, repr=False)
class Uncertainty:
    """Uncertainty of the forces, float32 arrays of their shape.

    shear_x, shear_y and normal are standard deviations, N. The others bound direction (rad) and
    magnitude (N) over the segment of an ambiguous pillar, without noise; phi runs counter-clockwise
    from low to high. What saturated sensels leave open is 1e38. Valid for pillars without
    missing sensels. Without pillars, all but normal is None.
    """

    normal: Floats
    shear_x: Optional[Floats] = None
    shear_y: Optional[Floats] = None
    theta_low: Optional[Floats] = None
    theta_high: Optional[Floats] = None
    phi_low: Optional[Floats] = None
    phi_high: Optional[Floats] = None
    magnitude_low: Optional[Floats] = None
    magnitude_high: Optional[Floats] = None

    def __repr__(self) -> str:
        return _short(self)


@dataclasses.dataclass(frozen=True, repr=False)
class Intervals:
    """Ends of the 95 % intervals of the forces, N, float32 arrays of their shape.

    Noise included; a normal force is not below zero. The interval of an ambiguous pillar spans what
    its estimator leaves possible (docs/formats.md). Without pillars, those of shear are None.
    """

    normal_low: Floats
    normal_high: Floats
    shear_x_low: Optional[Floats] = None
    shear_x_high: Optional[Floats] = None
    shear_y_low: Optional[Floats] = None
    shear_y_high: Optional[Floats] = None

    def __repr__(self) -> str:
        return _short(self)


@dataclasses.dataclass(frozen=True, repr=False)
class Points:
    """Forces as vectors at points, for simulators and learning.

    force_n: force on the skin in the body's frame, float32 [frames, N, 3] or [N, 3], N
    position_m: places of the pillars, float64 [N, 3], m
    normal: outward unit vectors there, float64 [N, 3]
    """

    force_n: Floats
    position_m: Doubles
    normal: Doubles

    def __repr__(self) -> str:
        return _short(self)


class ForceField:
    """Forces on the pillars of one frame, planes [P, Q], or of T frames, planes [T, P, Q].

    Without pillars, P and Q count sensels, and there is normal force alone.

    shear_x, shear_y: tangential force on the skin, + right and + up, float32, N; both None: no pillars
    normal: pressing force, float32, N
    status: bits of Status, uint8
    times: of the frames, float64 [T], or one number, s
    skin: Skin, for positions in mm; None: unknown

    Arrays own their memory. Those that a Processor lends are read-only and hold a slot of it until
    they are dropped; copy() owns what it has. Raises Error if the planes differ in shape.

    >>> import numpy as np, pillarfield as pf
    >>> one = np.ones((2, 3), np.float32)
    >>> pf.ForceField(0 * one, 0 * one, one, status=15 * one)
    <ForceField: 1 frame of 2 x 3 pillars, 1..1 N, 0 % ambiguous>
    """

    __slots__ = ("_planes", "_times", "_contacts", "_skin", "_solved_by")

    def __init__(self, shear_x: Optional[npt.ArrayLike], shear_y: Optional[npt.ArrayLike],
                 normal: npt.ArrayLike, *,
                 status: Optional[npt.ArrayLike] = None, times: Optional[npt.ArrayLike] = None,
                 skin: Optional[_core.Skin] = None) -> None:
        planes: dict[str, Any] = {
            name: np.asarray(plane, np.float32)
            for name, plane in zip(_FORCES, (shear_x, shear_y, normal)) if plane is not None}
        shape = planes["normal"].shape
        planes["status"] = np.asarray(0 * planes["normal"] if status is None else status, np.uint8)
        if len(shape) not in (2, 3) or any(plane.shape != shape for plane in planes.values()):
            raise Error("ForceField", "its planes differ in shape",
                        "give planes [pillar rows, cols] or [frames, pillar rows, cols]")
        if times is None:
            times = np.arange(shape[0]) * 0.01 if len(shape) == 3 else 0.0
        self._set(planes, np.asarray(times, np.float64), None, skin)
        if self._times.shape != shape[:-2]:
            raise Error("ForceField", f"it has {self._times.size} times", "give one a frame")

    def _set(self, planes: Mapping[str, Any], times: Doubles,
             contacts: Optional[Sequence[_core.FrameContacts]],
             skin: Optional[_core.Skin], solved_by: Optional[_core.SolvedBy] = None) -> None:
        self._planes = planes
        self._times = times
        self._contacts = contacts
        self._skin = skin
        self._solved_by = solved_by

    @classmethod
    def _of(cls, planes: Mapping[str, Any], times: Doubles,
            contacts: Optional[Sequence[_core.FrameContacts]],
            skin: Optional[_core.Skin],
            solved_by: Optional[_core.SolvedBy] = None) -> ForceField:
        field = cls.__new__(cls)
        field._set(planes, times, contacts, skin, solved_by)
        return field

    def _plane(self, name: str, output: str) -> Floats:
        try:
            plane: Floats = self._planes[name]
        except KeyError:
            if output != "uncertainty" and not self.has_pillars:
                raise MissingError("ForceField", f"without pillars there is no {name}",
                                   "give the skin the layout 'pillars', if it has some") from None
            raise MissingError("ForceField", f"it has no {name.removesuffix('_normal')}",
                               f"solve with outputs=['{output}']") from None
        return plane

    def __getattr__(self, name: str) -> Any:
        """Raises MissingError with a suggestion."""
        if name.startswith("__") or hasattr(type(self), name):
            return object.__getattribute__(self, name)
        hint = "; did you mean 'picture'?" if name in ("plot", "show") else _core.suggestion(
            name, [each for each in dir(type(self)) if each[0] != "_"])
        raise MissingError("ForceField", f"it has no '{name}'{hint}")

    @property
    def has_pillars(self) -> bool:
        """False: each sensel is by itself, with normal force alone."""
        return "shear_x" in self._planes

    @property
    def pressure_kpa(self) -> Floats:
        """Normal force over the area of a pillar, or of a sensel, float32, kPa.

        Raises Error without a skin.
        """
        return self.pressure()

    def pressure(self, unit: str = "kPa") -> Floats:
        """Normal force over the area of a pillar, or of a sensel, float32, in the unit.

        unit: 'kPa', 'psi' or 'mmHg'. Raises Error without a skin.
        """
        if self._skin is None:
            raise MissingError("ForceField.pressure", "the skin is unknown", "solve with skin=Skin(...)")
        kpa: Optional[float] = _core.pressure_units.get(unit)
        if kpa is None:
            raise Error("ForceField.pressure", f"'{unit}' is not a unit of pressure",
                        f"give {' or '.join(_core.pressure_units)}")
        if "sensel_pitch_mm" not in self._skin.stated:
            warn([f"A pitch of {self._skin.sensel_pitch_mm:.3g} mm is assumed; give pitch_mm= to solve()."])
        return self.normal * np.float32(1000 / kpa / self._skin.element_area_mm2)

    @property
    def shear_x(self) -> Floats:
        """Tangential force to the right, float32, N."""
        return self._plane("shear_x", "")

    @property
    def shear_y(self) -> Floats:
        """Tangential force up, float32, N."""
        return self._plane("shear_y", "")

    @property
    def normal(self) -> Floats:
        """Pressing force, float32, N."""
        return self._plane("normal", "")

    @property
    def status(self) -> Bytes:
        """Bits of Status, uint8."""
        status: Bytes = self._planes["status"]
        return status

    @property
    def region(self) -> Bytes:
        """Values of Region, uint8. Raises Error without pillars."""
        self._plane("shear_x", "")
        return REGIONS[self.status]

    @property
    def magnitude(self) -> Floats:
        """Size of the force, float32, N; with the output 'angles'."""
        return self._plane("magnitude", "angles")

    @property
    def theta(self) -> Floats:
        """Angle from the outward normal, float32, rad, 0..pi; with the output 'angles'."""
        return self._plane("theta", "angles")

    @property
    def phi(self) -> Floats:
        """Direction in the plane that the force comes from, float32, rad, -pi..pi; with 'angles'."""
        return self._plane("phi", "angles")

    @property
    def uncertainty(self) -> Uncertainty:
        """Standard deviations and bounds; with the output 'uncertainty'."""
        self._plane("uncertainty_normal", "uncertainty")
        return Uncertainty(**{field.name: self._planes[f"uncertainty_{field.name}"]
                              for field in dataclasses.fields(Uncertainty)
                              if f"uncertainty_{field.name}" in self._planes})

    @property
    def intervals(self) -> Intervals:
        """95 % intervals of the components, computed anew; with the output 'uncertainty'."""
        self._plane("uncertainty_normal", "uncertainty")
        ends = _core.component_ends(self._batch(), self._solved_by)
        return Intervals(**{name: plane.reshape(self.shape) for name, plane in ends.items()})

    @property
    def outputs(self) -> list[str]:
        """The optional outputs that it has: of 'angles' and 'uncertainty'."""
        names = {"theta": "angles", "uncertainty_normal": "uncertainty"}
        return [output for plane, output in names.items() if plane in self._planes]

    @property
    def times(self) -> Doubles:
        """Times of the frames, float64 [T], or [] for one frame, s."""
        return self._times

    @property
    def skin(self) -> Optional[_core.Skin]:
        """Skin of the pillars, or None."""
        return self._skin

    @property
    def contacts(self) -> Any:
        """FrameContacts of one frame, or a list of them; with contacts=True."""
        if self._contacts is None:
            raise MissingError("ForceField", "it has no contacts", "solve with contacts=True")
        return self._contacts if self.normal.ndim == 3 else self._contacts[0]

    def contact_records(self) -> npt.NDArray[Any]:
        """The contacts of all frames as NumPy records, a row for each contact in each frame.

        Fields are frame, time_s, id and the columns of contact files (docs/formats.md), N, mm, kPa.
        """
        return self._records(False)

    def total_records(self) -> npt.NDArray[Any]:
        """Force, centre of pressure, area and the like of the whole patch, a record for each frame.

        Fields are frame, time_s and the columns of contact files (docs/formats.md), N, mm, kPa.

        >>> import numpy as np, pillarfield as pf
        >>> forces = pf.solve(np.full((3, 8, 12), 32), counts_per_newton=320, contacts=True)
        >>> forces.total_records()["normal_n"].round(2)
        array([9.6, 9.6, 9.6])
        """
        return self._records(True)

    def _records(self, totals: bool) -> npt.NDArray[Any]:
        contacts = [self.contacts] if self.normal.ndim == 2 else self.contacts
        rows = [1 if totals else len(each) for each in contacts]
        columns: dict[str, npt.NDArray[Any]] = {
            "frame": np.repeat(np.arange(len(contacts)), rows),
            "time_s": np.repeat([each.time_s for each in contacts], rows),
            **_core.contact_columns(contacts, totals)}
        return np.rec.fromarrays(list(columns.values()), [(name, each.dtype) for name, each in columns.items()])

    def to_pandas(self, *, totals: bool = False) -> pandas.DataFrame:
        """contact_records(), or with totals total_records(), as a DataFrame.

        Raises Error where pandas is not installed.
        """
        try:
            import pandas
        except ImportError:
            raise Error("ForceField.to_pandas", "pandas is not installed",
                        "install it, or use contact_records()") from None
        return pandas.DataFrame(self._records(totals))

    @property
    def shape(self) -> tuple[int, ...]:
        """(T, P, Q), or (P, Q) for one frame."""
        return self.normal.shape

    def where(self, status: int) -> npt.NDArray[np.bool_]:
        """True where a pillar has any of these bits of Status."""
        return np.not_equal(self.status & np.uint8(status), 0)

    def __len__(self) -> int:
        """The number of frames."""
        return self.shape[0] if len(self.shape) == 3 else 1

    def __getitem__(self, frames: Union[int, slice]) -> ForceField:
        """One frame, or a slice of frames, over the same memory."""
        if len(self.shape) != 3:
            raise ArgumentError("ForceField", "it is one frame", "index its planes, such as forces.normal")
        if not isinstance(frames, slice):
            frames = range_of(frames, len(self))[0]
        contacts = self._contacts
        if contacts is not None:
            contacts = contacts[frames] if isinstance(frames, slice) else [contacts[frames]]
        planes = {name: plane[frames] for name, plane in self._planes.items()}
        return self._of(planes, np.asarray(self._times[frames]), contacts, self._skin,
                        self._solved_by)

    def __array__(self, *_: Any, **__: Any) -> Any:
        """Raises Error: several planes are no array."""
        raise ArgumentError("ForceField", f"it has the planes {', '.join(self._planes)}",
                            "give one, such as forces.normal")

    def __iter__(self) -> Iterator[ForceField]:
        """The frames."""
        return (self[frame] for frame in range(len(self)))

    def copy(self) -> ForceField:
        """The same field in memory of its own, writeable."""
        planes = {name: plane.copy() for name, plane in self._planes.items()}
        return self._of(planes, self._times.copy(), self._contacts, self._skin, self._solved_by)

    def _batch(self) -> dict[str, Any]:
        """Dense planes [T, P, Q]."""
        shape = (-1, *self.shape[-2:])
        return {name: np.ascontiguousarray(plane).reshape(shape)
                for name, plane in self._planes.items()}

    def save(self, path: Path, *, overwrite: bool = False) -> None:
        """Writes the forces; the extension chooses the format (docs/formats.md): .h5, .csv, .npy.

        Contacts are written too, in .h5.

        overwrite: replace any file, not only other results. Raises Error if it cannot be written.
        """
        side, layout = (2, "pillars") if self.has_pillars else (1, "sensels")
        skin = self._skin or _core.Skin(side * self.shape[-2], side * self.shape[-1], layout=layout)
        _core.save_forces(path, self._batch(), self._times.reshape(-1), self._contacts, skin,
                          self._solved_by, overwrite)

    def __repr__(self) -> str:
        frames = len(self)
        rows, cols = self.shape[-2:]
        size = np.sqrt(sum(self._planes[name]**2 for name in _FORCES if name in self._planes))
        low, high = (size.min(), size.max()) if size.size else (0, 0)
        text = f"{frames} frame{'s' * (frames != 1)} of {rows} x {cols}"
        if not self.has_pillars:
            return f"<ForceField: {text} sensels, {low:.3g}..{high:.3g} N>"
        touched = self.where(Status.USABLE)
        share = 100 * self.where(Status.AMBIGUOUS).sum() / max(1, touched.sum())
        return f"<ForceField: {text} pillars, {low:.3g}..{high:.3g} N, {share:.0f} % ambiguous>"

    def picture(self, quantity: str = "normal", *, limits: Optional[tuple[float, float]] = None,
                theme: str = "dark") -> bytes:
        """A picture of one frame as PNG: heat map in the viewer's colours, arrows of the shear.

        quantity: normal, pressure, status, uncertainty; of pillars also shear, shear_x, shear_y,
            magnitude, theta, phi, region
        limits: ends of the colour bar, N, kPa or rad; None: fitting ones
        theme: 'dark' or 'light'

        Raises Error if the forces are of several frames or lack the quantity; for the pressure, if
        the skin is unknown.
        """
        if len(self.shape) != 2:
            raise Error("ForceField.picture", "the forces are of several frames", "index one")
        if theme not in ("dark", "light"):
            raise Error("ForceField.picture", f"'{theme}' is not a theme", "give 'dark' or 'light'")
        return picture(self._batch(), quantity, limits, theme == "light", self._skin)

    def _repr_png_(self) -> Optional[bytes]:
        """For notebooks: the picture of the frame, or of the one with the largest normal force."""
        if len(self.shape) == 2:
            return self.picture()
        if not len(self):
            return None
        return self[int(self.normal.sum((1, 2)).argmax())].picture()

    def to_xarray(self) -> xarray.Dataset:
        """The planes as an xarray.Dataset with coordinates time (s), y and x (mm); needs xarray."""
        import xarray

        rows, cols = self.shape[-2:]
        row_mm, col_mm = np.broadcast_to(self._skin.element_pitch_mm if self._skin else 1.0, 2)
        coordinates: dict[str, Any] = {
            "y": ("y", (np.arange(rows)[::-1] - (rows - 1) / 2) * row_mm, {"units": "mm"}),
            "x": ("x", (np.arange(cols) - (cols - 1) / 2) * col_mm, {"units": "mm"})}
        axes = ("y", "x")
        if len(self.shape) == 3:
            axes = ("time", *axes)  # type: ignore[assignment]
            coordinates["time"] = ("time", self._times, {"units": "s"})

        def unit(name: str) -> dict[str, str]:
            if name == "status":
                return {}
            return {"units": "rad" if "theta" in name or "phi" in name else "N"}

        return xarray.Dataset({name: (axes, plane, unit(name))
                               for name, plane in self._planes.items()}, coordinates)

    def to_points(self) -> Points:
        """The forces as vectors in the body's frame at the places of the pillars.

        The body's frame has its origin at the middle of the skin; x points right, y up, z outwards.
        Raises Error without a skin.
        """
        if self._skin is None:
            raise Error("ForceField.to_points", "the skin is unknown", "solve with skin=Skin(...)")
        position, tangent_x, tangent_y, normal = _core.poses(self._skin).reshape(4, -1, 3)
        shape = (*self.shape[:-2], -1, 1)
        force = -self.normal.reshape(shape) * normal
        if self.has_pillars:
            force = (self.shear_x.reshape(shape) * tangent_x
                     + self.shear_y.reshape(shape) * tangent_y + force)
        return Points(force.astype(np.float32), position / 1000, normal)

    def to_lerobot(self, name: str = "skin") -> tuple[Columns, Features]:
        """The forces for a LeRobotDataset: its column and the entry of its features.

        name: of the skin; the key of both is 'observation.tactile.NAME'

        The column is float32 [T, rows, cols, channels], N, of one frame [rows, cols, channels], as
        add_frame() takes it. Channels are shear_x, shear_y, normal; without pillars normal alone.
        The features are an entry of those that LeRobotDataset.create() takes, as LeRobot 0.6.2
        checks them (datasets v3.0, and v2.1 before them). Raises Error for a name that LeRobot refuses.

        >>> import numpy as np, pillarfield as pf
        >>> forces = pf.solve(np.zeros((5, 8, 12)), counts_per_newton=320, layout="pillars")
        >>> columns, features = forces.to_lerobot("left")
        >>> columns["observation.tactile.left"].shape
        (5, 4, 6, 3)
        >>> features["observation.tactile.left"]
        {'dtype': 'float32', 'shape': (4, 6, 3), 'names': ['shear_x', 'shear_y', 'normal']}
        """
        channels = _FORCES if self.has_pillars else ("normal",)
        return columns_and_features({channel: getattr(self, channel) for channel in channels}, name)

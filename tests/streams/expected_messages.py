"""What the messages of each topic must hold, computed from the force file and the recording of the
same frames."""

import h5py
import numpy as np

from cdr_reader import field_of, image_of, points_of, stamp_ns

SLOTS = 16
FILES_ONLY = [f"{plane}_{end}" for plane in ("shear_x", "shear_y", "normal") for end in ("low", "high")]


class Frames:
    """The frames of a force file with contacts and of a recording; on a cylinder along y if it has a
    radius."""

    def __init__(self, forces, recording, radius_mm=None):
        self.radius_mm = radius_mm
        with h5py.File(forces) as file:
            self.pitch = float(file.attrs["pillar_pitch_mm"])
            self.planes = {name: file["force"][name][()]
                           for name in ("shear_x", "shear_y", "normal", "status")}
            self.field = dict(self.planes)  # what /skin/field must hold
            for name, plane in file.get("uncertainty", {}).items():
                if name not in FILES_ONLY:
                    self.field[f"uncertainty_{name}"] = plane[()]
            self.time = file["force/time"][()]
            columns = {name: data[()] for name, data in file["contacts"].items()
                       if isinstance(data, h5py.Dataset)}
            totals = {name: data[()] for name, data in file["contacts/patch"].items()}
        with h5py.File(recording) as file:
            self.raw = file["frames/raw"][()]
        rows = [dict(zip(columns, values)) for values in zip(*columns.values())]
        self.totals = [dict(zip(totals, values)) for values in zip(*totals.values())]
        self.contacts = [[row for row in rows if row["frame"] == frame]
                         for frame in range(len(self.time))]
        self.slots = list(self.assigned_slots())

    def place(self, x_mm, y_mm):
        """Places of points of the skin in space, m."""
        x_mm, y_mm = np.asarray(x_mm), np.asarray(y_mm)
        if self.radius_mm is None:
            return 1e-3 * np.array([x_mm, y_mm, 0 * x_mm])
        angle = x_mm / self.radius_mm
        return 1e-3 * np.array([self.radius_mm * np.sin(angle), y_mm,
                                self.radius_mm * (np.cos(angle) - 1)])

    def assigned_slots(self):
        """For each frame, the contact of each slot, or None; False if it has just ended."""
        slots = [None] * SLOTS
        for contacts in self.contacts:
            alive = {contact["id"]: contact for contact in contacts}
            previous, slots = slots, [alive.pop(old["id"], False) if old else None for old in slots]
            for contact in contacts:
                if contact["id"] in alive and not all(slots):
                    slots[[bool(slot) for slot in slots].index(False)] = contact
            yield slots


def wrench_of(contact):
    """Force, N, and moment about the origin, N m, of a contact."""
    if not contact:
        return [0.0] * 6
    if "force_x_n" in contact:
        force = [contact[f"force_{axis}_n"] for axis in "xyz"]
        moment = [contact[f"moment_{axis}_nmm"] for axis in "xyz"]
    else:
        place = np.array([contact["centre_of_pressure_x_mm"], contact["centre_of_pressure_y_mm"], 0])
        force = [contact["shear_x_n"], contact["shear_y_n"], -contact["normal_n"]]
        moment = np.cross(place, force) + [0, 0, contact["torque_nmm"]]
    return [*force, *(1e-3 * np.array(moment))]


def check_message(test, frames, topic, index, message):
    """Compares a decoded message of a frame with the files."""
    if topic == "/skin/normal":
        np.testing.assert_array_equal(image_of(message), frames.planes["normal"][index])
    elif topic == "/skin/raw":
        np.testing.assert_array_equal(image_of(message), frames.raw[index])
    elif topic == "/skin/forces":
        check_points(frames, index, points_of(message))
    elif topic == "/skin/field":
        check_field(test, frames, index, message)
    elif topic == "/skin/time":
        test.assertAlmostEqual(stamp_ns({"stamp": message["time_ref"]}) * 1e-9, frames.time[index],
                               delta=2e-9)
    elif topic == "/skin/arrows":
        check_arrows(test, frames, index, message["markers"])
    else:
        slot = int(topic.removeprefix("/skin/contacts/")) - 1
        contact = frames.slots[index][slot]
        test.assertIsNotNone(contact, f"{topic} in frame {index}")
        wrench = message["wrench"]
        got = [*wrench["force"].values(), *wrench["torque"].values()]
        np.testing.assert_allclose(got, wrench_of(contact), rtol=1e-14, atol=1e-15)


def check_points(frames, index, points):
    planes = {name: plane[index] for name, plane in frames.planes.items()}
    touched = (planes["status"] & 15) != 0
    for name, plane in planes.items():
        np.testing.assert_array_equal(points[name], plane[touched])
    rows, cols = planes["status"].shape
    row, col = np.nonzero(touched)
    place = frames.place((col - (cols - 1) / 2) * frames.pitch, ((rows - 1) / 2 - row) * frames.pitch)
    np.testing.assert_allclose([points[axis] for axis in "xyz"], place, atol=1e-8)


def check_field(test, frames, index, message):
    """A Grid begins at the corner of the lowest and leftmost cell, in the plane of the flat skin."""
    field = field_of(message)[::-1]
    test.assertEqual(set(field.dtype.names), set(frames.field))
    for name, plane in frames.field.items():
        test.assertEqual(field[name].dtype, plane.dtype)
        np.testing.assert_array_equal(field[name], plane[index])
    rows, cols = field.shape
    pitch_m = 1e-3 * frames.pitch
    test.assertEqual([*message["cell_size"].values()], [pitch_m, pitch_m])
    np.testing.assert_allclose([*message["pose"]["position"].values()],
                               [-cols / 2 * pitch_m, -rows / 2 * pitch_m, 0], rtol=1e-14)
    test.assertEqual([*message["pose"]["orientation"].values()], [0, 0, 0, 1])
    test.assertEqual(message["frame_id"], "skin" if frames.radius_mm is None else "skin_flat")


def check_arrows(test, frames, index, markers):
    test.assertEqual(markers[0]["action"], 3)  # delete the earlier ones
    arrows = {marker["id"]: marker for marker in markers[1:]}
    contacts = {contact["id"]: contact for contact in frames.contacts[index]}
    test.assertEqual(arrows.keys(), contacts.keys())
    for slot, contact in enumerate(frames.slots[index]):
        if contact:
            test.assertEqual(arrows[contact["id"]]["ns"], f"/skin/contacts/{slot + 1}")
    for track, contact in contacts.items():
        start, tip = ([*point.values()] for point in arrows[track]["points"])
        np.testing.assert_allclose(tip, frames.place(contact["centre_of_pressure_x_mm"],
                                                     contact["centre_of_pressure_y_mm"]), atol=1e-14)
        np.testing.assert_allclose(np.subtract(tip, start), 0.01 * np.array(wrench_of(contact)[:3]),
                                   atol=1e-15)

"""A person states details of a calibration for its report that the program cannot know."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Details:
    """The details that are stated of a calibration; empty where they are not."""

    id: str = field(default="", metadata={"label": "Number of the report"})
    operator: str = field(default="", metadata={"label": "Operator"})
    laboratory: str = field(default="", metadata={"label": "Laboratory"})
    place: str = field(default="", metadata={"label": "Place of calibration"})
    temperature: str = field(default="", metadata={"label": "Temperature"})
    customer: str = field(default="", metadata={"label": "Customer"})
    camera: str = field(default="", metadata={"label": "Camera"})
    camera_serial: str = field(default="", metadata={"label": "Serial number of the camera"})
    lens: str = field(default="", metadata={"label": "Lens"})
    lens_serial: str = field(default="", metadata={"label": "Serial number of the lens"})
    setting: str = field(default="", metadata={"label": "Aperture, focus, zoom"})
    condition: str = field(default="", metadata={"label": "Condition of the item"})
    received: str = field(default="", metadata={"label": "Date of receipt"})
    calibrated: str = field(default="", metadata={"label": "Date of calibration"})
    board: str = field(default="", metadata={"label": "Identification of the board"})
    board_certificate: str = field(default="", metadata={"label": "Certificate of the board"})
    remarks: str = field(default="", metadata={"label": "Remarks"})
    signatory: str = field(default="", metadata={"label": "Authorised by"})


NO_DETAILS = Details()

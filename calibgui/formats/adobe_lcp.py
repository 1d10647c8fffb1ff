"""A lens profile of Adobe's in XMP.

Reader: Lightroom, Camera Raw and Photoshop, RawTherapee and darktable's relatives. The perspective
model is Brown's, with k1 k2 k3 of OpenCV as RadialDistortParam1 to 3, and p1 and p2 as
TangentialDistortParam1 and 2; the fisheye model is Kannala and Brandt's with k1 and k2 alone. Focal
lengths are shares of the image's longer side; the centre is a share of width and height, from a
corner: pixels have whole numbers at their corners there. The profile is for the images as the
sensor has them, before they are turned.
Cannot hold: other lens models and skew (they are refitted), standard deviations, poses, corners.
"""

from __future__ import annotations

import math
from html import escape
from pathlib import Path

from calibgui.dataset import UNKNOWN_HARDWARE, Hardware, Result
from calibgui.engine.camera import Camera
from calibgui.engine.geometry import corner_from_array
from calibgui.formats.camera_refit import write_in_models
from calibgui.formats.exporter import Exporter, ExportReport

_COEFFICIENTS = {
    "RadialDistortParam1": "k1",
    "RadialDistortParam2": "k2",
    "RadialDistortParam3": "k3",
    "TangentialDistortParam1": "p1",
    "TangentialDistortParam2": "p2",
}
"""Our names of the profile's coefficients."""


_FISHEYE = "kannala-brandt"


def write_lcp(result: Result, path: Path) -> ExportReport:
    """Write a profile of one camera."""
    hardware = result.find_hardware()
    return write_in_models(
        result, path, EXPORTER, lambda fitted, note: format_profile(fitted.camera, note, hardware)
    )


def format_profile(camera: Camera, note: str, hardware: Hardware = UNKNOWN_HARDWARE) -> str:
    """Return the text of the file; `camera` is in one of the format's models."""
    width, height = camera.size
    longer = max(camera.size)
    crop = hardware.crop or 1.0
    film = math.hypot(36, 24) / crop * longer / math.hypot(width, height)
    values = dict(zip(camera.names, camera.params.tolist(), strict=True))
    centre = (corner_from_array(camera.centre) / camera.size).tolist()
    named = {
        "Author": "calibgui",
        "ProfileName": note,
        "Make": hardware.maker or "calibgui",
        "Model": hardware.model or "camera",
        "Lens": hardware.lens or "lens",
        "LensPrettyName": hardware.lens or "lens",
        "CameraRawProfile": "False",
        "SensorFormatFactor": f"{crop:.6g}",
        "ImageWidth": str(width),
        "ImageLength": str(height),
        "FocalLength": f"{values['fx'] / longer * film:.4g}",
    }
    is_fisheye = camera.model == _FISHEYE
    kind = "FisheyeModel" if is_fisheye else "PerspectiveModel"
    of_lens = {
        key: repr(values.get(name, 0.0))
        for key, name in list(_COEFFICIENTS.items())[: 2 if is_fisheye else None]
    }
    model = {
        "Version": "2",
        "FocalLengthX": repr(values["fx"] / longer),
        "FocalLengthY": repr(values["fy"] / longer),
        "ImageXCenter": repr(centre[0]),
        "ImageYCenter": repr(centre[1]),
        **of_lens,
    }
    return f"""\
<x:xmpmeta xmlns:x="adobe:ns:meta/">
 <rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#">
  <rdf:Description rdf:about="" xmlns:photoshop="http://ns.adobe.com/photoshop/1.0/"
    xmlns:stCamera="http://ns.adobe.com/photoshop/1.0/camera-profile">
   <photoshop:CameraProfiles>
    <rdf:Seq>
     <rdf:li>
      <rdf:Description{_list_attributes(named, 7)}>
       <stCamera:{kind}>
        <rdf:Description{_list_attributes(model, 9)}/>
       </stCamera:{kind}>
      </rdf:Description>
     </rdf:li>
    </rdf:Seq>
   </photoshop:CameraProfiles>
  </rdf:Description>
 </rdf:RDF>
</x:xmpmeta>
"""


def _list_attributes(values: dict[str, str], indent: int) -> str:
    start = "\n" + " " * indent
    return "".join(f'{start}stCamera:{key}="{escape(value)}"' for key, value in values.items())


EXPORTER = Exporter(
    name="lcp",
    title="Adobe lens profile",
    suffixes=(".lcp",),
    models=("brown-conrady", "brown-conrady-4", "pinhole", _FISHEYE),
    refits=("brown-conrady", _FISHEYE),
    zeros={_FISHEYE: ("k3", "k4")},
    readers="Lightroom, Camera Raw, RawTherapee",
    keeps="the camera with k1 to k3, p1 and p2, as fisheye with k1 and k2, the names of camera and "
    "lens",
    loses="standard deviations, poses, corners",
    write=write_lcp,
)

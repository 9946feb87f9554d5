"""Pictures that people give: known by what is in them, and sent as nothing else.

What comes from outside is hostile: neither its name nor the type it claims counts. A picture that is none, or
one that is something else as well, is never run: it goes out with a fixed type that browsers may not guess
over, and with a policy that lets nothing in it act.
"""

from typing import Final

from starlette.responses import Response

from service.api.problems import WrongFieldError
from service.storage.records import InspectionPicture

MAX_PICTURE_BYTES: Final = 1024 * 1024
PNG: Final = "image/png"
JPEG: Final = "image/jpeg"
_PNG_BEGIN: Final = b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR"
_PNG_END: Final = b"IEND\xaeB`\x82"
_JPEG_BEGIN: Final = b"\xff\xd8\xff"
_JPEG_END: Final = b"\xff\xd9"
_HEADERS: Final = {
    "X-Content-Type-Options": "nosniff",
    "Content-Security-Policy": "default-src 'none'; sandbox",
    "Cache-Control": "private, max-age=86400",
}


def picture_of(content: bytes, where: str) -> InspectionPicture:
    """Return a picture with the type that its content has. where: the field, for the message.

    Raises ProblemError for what is no whole PNG and no whole JPEG, or too large.
    """
    if len(content) > MAX_PICTURE_BYTES:
        raise WrongFieldError(
            where, f"expected a picture of at most {MAX_PICTURE_BYTES} bytes, found {len(content)}"
        )
    if content.startswith(_PNG_BEGIN) and content.endswith(_PNG_END):
        return InspectionPicture(PNG, content)
    if content.startswith(_JPEG_BEGIN) and content.endswith(_JPEG_END):
        return InspectionPicture(JPEG, content)
    raise WrongFieldError(where, "expected a whole PNG or JPEG, found something else: save it as one of them")


def picture_answer(picture: InspectionPicture) -> Response:
    """Return a picture as an answer."""
    name = "picture.png" if picture.media_type == PNG else "picture.jpg"
    headers = {**_HEADERS, "Content-Disposition": f'inline; filename="{name}"'}
    return Response(picture.content, media_type=picture.media_type, headers=headers)

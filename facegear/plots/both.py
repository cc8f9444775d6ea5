"""A figure as drawing (svg) and as picture (png) at once: matplotlib goes over its artists once for both."""

from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backend_bases import GraphicsContextBase, RendererBase
from matplotlib.backends.backend_agg import FigureCanvasAgg, RendererAgg
from matplotlib.backends.backend_svg import RendererSVG
from matplotlib.font_manager import FontProperties
from matplotlib.path import Path as Curve
from matplotlib.textpath import text_to_path
from matplotlib.transforms import Affine2D, Bbox, Transform, TransformedPath
from PIL import Image

POINTS = 72
"""Units of a drawing to an inch."""
EFFORT = 3
"""Of the compression of a picture (1 to 9): twice as fast as the usual 6, for 4 % more bytes."""


class Picture(RendererAgg):
    """A picture whose letters are the curves that a drawing has: what is known of them serves both."""

    def draw_text(
        self,
        gc: GraphicsContextBase,
        x: float,
        y: float,
        s: str,
        prop: FontProperties,
        angle: float,
        ismath: Any = False,
        mtext: Any = None,
    ) -> None:
        self._draw_text_as_path(gc, x, y, s, prop, angle, ismath, mtext)

    def get_text_width_height_descent(
        self, s: str, prop: FontProperties, ismath: Any
    ) -> tuple[float, float, float]:
        width, height, descent = text_to_path.get_text_width_height_descent(s, prop, ismath)
        pixels = self.points_to_pixels(1.0)
        return pixels * width, pixels * height, pixels * descent


class Canvas(FigureCanvasAgg):
    """What a figure of a set resolution is laid out for, and its picture drawn on."""

    @cached_property
    def picture(self) -> Picture:
        """The picture, empty until the figure is drawn."""
        return Picture(*self.get_width_height(physical=True), self.figure.dpi)

    def get_renderer(self) -> Picture:
        return self.picture


def draw_both(canvas: Canvas, svg: Path, png: Path) -> None:
    """Write the figure of a canvas to both files."""
    figure, picture = canvas.figure, canvas.picture
    width, height = POINTS * figure.get_size_inches()
    with open(svg, "w", encoding="utf-8") as stream:
        drawing = RendererSVG(width, height, stream, image_dpi=figure.dpi, metadata={"Date": None})
        figure.draw(_Both(picture, drawing))
        drawing.finalize()
    write_picture(picture, png)


def draw_picture(canvas: Canvas, png: Path) -> None:
    """Write the figure of a canvas as a picture alone."""
    canvas.picture.clear()
    canvas.figure.draw(canvas.picture)
    write_picture(canvas.picture, png)


def write_picture(picture: Picture, png: Path) -> None:
    """Write what is drawn of a picture, which has no transparent parts."""
    opaque = np.ascontiguousarray(np.asarray(picture.buffer_rgba())[..., :3])
    resolution = (picture.dpi, picture.dpi)
    Image.fromarray(opaque).save(png, format="png", compress_level=EFFORT, dpi=resolution)


class _Both(RendererBase):
    """Draws into a picture, in whose pixels all is given, and the same in points into a drawing.

    What a figure wants as pixels in a drawing, too, is drawn there into a picture that becomes a part of it.
    """

    def __init__(self, picture: RendererAgg, drawing: RendererSVG) -> None:
        super().__init__()
        self.picture, self.drawing = picture, drawing
        self.pixels: RendererAgg | None = None
        self.scale = Affine2D().scale(POINTS / picture.dpi)

    def start_rasterizing(self) -> None:
        self.pixels = RendererAgg(self.picture.width, self.picture.height, self.picture.dpi)

    def stop_rasterizing(self) -> None:
        assert self.pixels is not None
        drawn, self.pixels = np.asarray(self.pixels.buffer_rgba()), None
        rows, columns = (np.flatnonzero(drawn[..., 3].any(axis=axis)) for axis in (1, 0))
        if rows.size:
            part = drawn[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1][::-1]
            x, y = self._points(columns[0], rows[-1] + 1)
            self.drawing.draw_image(self.new_gc(), x, self.drawing.height - y, part)

    def _points(self, x: float, y: float) -> tuple[float, float]:
        """A place, y downwards, in points; a picture ends with its last whole pixel, a drawing does not."""
        ratio = POINTS / self.picture.dpi
        return ratio * x, self.drawing.height - ratio * (self.picture.height - y)

    def _scaled(self, gc: GraphicsContextBase) -> GraphicsContextBase:
        """The same pen, its clips in points. Its widths are in points already."""
        scaled = self.new_gc()
        scaled.copy_properties(gc)
        if (box := gc.get_clip_rectangle()) is not None:
            scaled.set_clip_rectangle(Bbox(self.scale.transform(box.get_points())))
        path, transform = gc.get_clip_path()
        if path is not None:
            scaled.set_clip_path(TransformedPath(path, transform + self.scale))
        return scaled

    def open_group(self, s: str, gid: str | None = None) -> None:
        if self.pixels is None:
            self.drawing.open_group(s, gid)

    def close_group(self, s: str) -> None:
        if self.pixels is None:
            self.drawing.close_group(s)

    def draw_path(
        self, gc: GraphicsContextBase, path: Curve, transform: Transform, rgbFace: Any = None
    ) -> None:
        self.picture.draw_path(gc, path, transform, rgbFace)
        if self.pixels is not None:
            self.pixels.draw_path(gc, path, transform, rgbFace)
        else:
            self.drawing.draw_path(self._scaled(gc), path, transform + self.scale, rgbFace)

    def draw_markers(
        self,
        gc: GraphicsContextBase,
        marker_path: Curve,
        marker_trans: Transform,
        path: Curve,
        trans: Transform,
        rgbFace: Any = None,
    ) -> None:
        self.picture.draw_markers(gc, marker_path, marker_trans, path, trans, rgbFace)
        if self.pixels is not None:
            self.pixels.draw_markers(gc, marker_path, marker_trans, path, trans, rgbFace)
        else:
            scaled = marker_trans + self.scale, path, trans + self.scale
            self.drawing.draw_markers(self._scaled(gc), marker_path, *scaled, rgbFace)

    def draw_path_collection(
        self,
        gc: GraphicsContextBase,
        master_transform: Transform,
        paths: Any,
        all_transforms: Any,
        offsets: Any,
        offset_trans: Transform,
        *looks: Any,
        **more: Any,
    ) -> None:
        shapes = master_transform, paths, all_transforms, offsets, offset_trans
        self.picture.draw_path_collection(gc, *shapes, *looks, **more)
        if self.pixels is not None:
            self.pixels.draw_path_collection(gc, *shapes, *looks, **more)
        else:
            shapes = master_transform + self.scale, paths, all_transforms, offsets, offset_trans + self.scale
            self.drawing.draw_path_collection(self._scaled(gc), *shapes, *looks, **more)

    def draw_quad_mesh(
        self,
        gc: GraphicsContextBase,
        master_transform: Transform,
        meshWidth: int,
        meshHeight: int,
        coordinates: Any,
        offsets: Any,
        offsetTrans: Transform,
        *looks: Any,
    ) -> None:
        mesh = meshWidth, meshHeight, coordinates, offsets
        self.picture.draw_quad_mesh(gc, master_transform, *mesh, offsetTrans, *looks)
        if self.pixels is not None:
            self.pixels.draw_quad_mesh(gc, master_transform, *mesh, offsetTrans, *looks)
        else:
            scaled = self._scaled(gc), master_transform + self.scale, *mesh, offsetTrans + self.scale
            self.drawing.draw_quad_mesh(*scaled, *looks)

    def draw_gouraud_triangles(
        self, gc: GraphicsContextBase, triangles_array: Any, colors_array: Any, transform: Transform
    ) -> None:
        self.picture.draw_gouraud_triangles(gc, triangles_array, colors_array, transform)
        if self.pixels is not None:
            self.pixels.draw_gouraud_triangles(gc, triangles_array, colors_array, transform)
        else:
            scaled = self._scaled(gc), triangles_array, colors_array, transform + self.scale
            self.drawing.draw_gouraud_triangles(*scaled)

    def draw_image(self, gc: GraphicsContextBase, x: float, y: float, im: Any, transform: Any = None) -> None:
        self.picture.draw_image(gc, x, y, im)
        if self.pixels is not None:
            self.pixels.draw_image(gc, x, y, im)
        else:
            ratio = POINTS / self.picture.dpi
            self.drawing.draw_image(self._scaled(gc), ratio * x, ratio * y, im)

    def draw_text(
        self,
        gc: GraphicsContextBase,
        x: float,
        y: float,
        s: str,
        prop: FontProperties,
        angle: float,
        ismath: Any = False,
        mtext: Any = None,
    ) -> None:
        self.picture.draw_text(gc, x, y, s, prop, angle, ismath, mtext)
        if self.pixels is not None:
            self.pixels.draw_text(gc, x, y, s, prop, angle, ismath, mtext)
        else:
            self.drawing.draw_text(self._scaled(gc), *self._points(x, y), s, prop, angle, ismath, mtext)

    def get_text_width_height_descent(
        self, s: str, prop: FontProperties, ismath: Any
    ) -> tuple[float, float, float]:
        return self.picture.get_text_width_height_descent(s, prop, ismath)

    def flipy(self) -> bool:
        return True

    def get_canvas_width_height(self) -> tuple[float, float]:
        return self.picture.get_canvas_width_height()

    def points_to_pixels(self, points: Any) -> Any:
        return self.picture.points_to_pixels(points)

    def option_image_nocomposite(self) -> bool:
        return self.picture.option_image_nocomposite()

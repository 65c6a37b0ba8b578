// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "MacroToolbar.h"

#include "vtkPythonInterpreter.h"

#include <QApplication>
#include <QDir>
#include <QFile>
#include <QIcon>
#include <QMainWindow>
#include <QTimer>
#include <QToolBar>

namespace
{

QString read(const QString& path)
{
  QFile file(path);
  return file.open(QIODevice::ReadOnly) ? QString::fromUtf8(file.readAll()) : QString();
}

/// The words of the macro's name, and the first sentence of its documentation.
QString describe(const QString& name, const QString& code)
{
  return QString(name).replace('_', ' ') + ": " +
    code.section("\"\"\"", 1, 1).section(". ", 0, 0).simplified();
}

/// A macro runs in names of its own, so that it does not change those of the user's console.
void run(const QString& name, const QString& code)
{
  vtkPythonInterpreter::Initialize();
  const QByteArray text = code.toUtf8().toBase64();
  const QString call = "import base64\nexec(compile(base64.b64decode('%1'), '%2.py', 'exec'),"
                       " {'__name__': '%2'})\n";
  vtkPythonInterpreter::RunSimpleString(
    call.arg(QString::fromLatin1(text), name).toUtf8().constData());
}

void addButtons(QToolBar* toolbar)
{
  const QDir folder(":/SurfaceDiffusion");
  for (const QString& entry : folder.entryList({ "*.py" }, QDir::Files, QDir::Name))
  {
    const QString name = entry.section('.', 0, 0);
    const QString code = read(folder.filePath(entry));
    QAction* button = toolbar->addAction(QIcon(folder.filePath(name + ".png")), name);
    button->setObjectName(name);
    button->setToolTip(describe(name, code));
    QObject::connect(button, &QAction::triggered, toolbar, [name, code]() { run(name, code); });
  }
}

void addToWindow()
{
  for (QWidget* widget : QApplication::topLevelWidgets())
  {
    if (auto* window = qobject_cast<QMainWindow*>(widget))
    {
      auto* toolbar = new QToolBar("Surface Diffusion Macros", window);
      toolbar->setObjectName("SurfaceDiffusionMacros");
      addButtons(toolbar);
      window->addToolBarBreak(); // a row of its own: the others are full
      window->addToolBar(toolbar);
      return;
    }
  }
}

} // namespace

void addMacroToolbar()
{
  Q_INIT_RESOURCE(macros);
  if (qobject_cast<QApplication*>(QCoreApplication::instance()))
  {
    // Plugins of PV_PLUGIN_PATH are loaded before there is a window.
    QTimer::singleShot(0, addToWindow);
  }
}
